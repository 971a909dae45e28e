// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"

#include <span>

namespace penumbra::maps {

/// Returns the family's table of methods, best methods first.
std::span<const engines::MethodRow> methods();

}  // namespace penumbra::maps
