// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// View samples on surfaces instead of at a camera's pixels: at texels of a lightmap, or at vertices.
namespace penumbra::visibility {

/// A point of a triangle (its index in the scene) by barycentric coordinates of its three corners in the soup's order,
/// which add up to 1. kBackground: no point.
struct SurfacePoint {
  std::int32_t triangle = ViewSamples::kBackground;
  glm::dvec3 shares{0};
};

enum class SurfaceSide : std::uint8_t {
  front,  ///< the side from which the soup's corners run counter-clockwise
  back,
};

/// Returns the view sample of each point, `camera.width` per row. p is the weighted sum of the scene's stored float32
/// corners, in double, rounded once; n and `facing` are those of the triangle's plane on the chosen side, exactly;
/// depth is the distance from the camera's eye along its axis, which affects nothing. Points of triangles without area
/// become background. `soup`: the scene's triangles with their original order of corners.
ViewSamples surface_view_samples(const SceneFloats& scene, std::span<const mesh::Triangle> soup,
                                 const PinholeCamera& camera, std::span<const SurfacePoint> points, SurfaceSide side);

/// Texels of a lightmap whose centres are covered by triangles.
struct TexelPoints {
  std::vector<SurfacePoint> points;  ///< row by row from the top left
  std::uint64_t covered = 0;
  std::uint64_t overlaps = 0;  ///< number of times that a centre was inside a further triangle: the first one counts
  std::uint64_t outside = 0;   ///< triangles that extend beyond the unit square
  std::uint64_t unmapped = 0;  ///< triangles without finite coordinates, or without area in the map
};

/// Finds the texel points. `triangles` are indices into `soup`; `places` has the coordinates of each position in the
/// lightmap, (0, 0) its top left, (1, 1) its bottom right. The centre of texel (x, y) lies at ((x + ½) / width, (y + ½)
/// / height). A centre on an edge is covered, so that no gap opens between neighbours: their common edge has one sign,
/// computed from its ends in lexicographic order. Of several triangles that cover a centre, the first counts.
TexelPoints texel_points(std::span<const mesh::Triangle> soup, std::span<const std::uint32_t> triangles,
                         std::span<const glm::dvec2> places, std::uint32_t width, std::uint32_t height);

/// Returns for each texel the covered texel whose value it shows: itself, or, up to `margin` texels around covered
/// ones, the nearest by steps to one of eight neighbours, in rows and columns first; others −1.
std::vector<std::int64_t> margin_sources(std::span<const SurfacePoint> points, std::uint32_t width,
                                         std::uint32_t margin);

}  // namespace penumbra::visibility
