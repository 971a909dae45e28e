// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"

#include <span>
#include <string_view>

namespace penumbra::maps {

/// Returns the family's table of methods, best methods first.
std::span<const engines::MethodRow> methods();

/// Returns whether a method, of any family, can process the triangles of scenes with planar lights and suns as they
/// pass (visibility::PassesTriangles) with these options: one map from the light's centre, and products that need no
/// triangles.
bool passes_triangles(std::string_view name, const visibility::MethodOptions& options);

}  // namespace penumbra::maps
