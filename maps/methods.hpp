#pragma once

#include "engines/method_row.hpp"

#include <span>

namespace penumbra::maps {

/// The family's table of methods; the best come first.
std::span<const engines::MethodRow> methods();

}  // namespace penumbra::maps
