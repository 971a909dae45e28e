// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"

#include <span>
#include <string_view>

namespace penumbra::maps {

/// Returns the family's table of methods, best methods first.
std::span<const engines::MethodRow> methods();

/// Returns whether a method, of any family, takes with these options all triangles of planar lights and suns as they
/// pass (visibility::PassesTriangles): one map from the light's centre, without products.
bool passes_triangles(std::string_view name, const visibility::MethodOptions& options);

}  // namespace penumbra::maps
