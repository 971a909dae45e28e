// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/emitters/welded.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::import {

/// A flat convex part of a mesh.
struct ConvexPart {
  std::vector<std::uint32_t> outline;  ///< point indices, counter-clockwise as seen from the front
  glm::dvec3 normal{0};                ///< unit
};

/// Divides a mesh into few flat convex parts: triangles are joined across common edges, longest first, as long as the
/// result is flat and convex (Hertel and Mehlhorn, "Fast triangulation of simple polygons", 1983, section 3, where any
/// order gives at most four times the smallest number of parts). Each triangle is in one part. `rounding`, the distance
/// of each point from its intended place, alone decides what is flat and convex. Triangles whose height is within the
/// rounding face no definite side, and are left out.
std::vector<ConvexPart> convex_parts(const Welded& mesh, double rounding);

/// Divides the triangles (indices) into regions: two triangles at a common edge are in one region if the two are flat
/// together. Small bends may add up: a region need not be flat.
std::vector<std::vector<std::size_t>> flat_regions(const Welded& mesh, double rounding);

}  // namespace penumbra::import
