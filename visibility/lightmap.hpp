#pragma once

#include "mesh/triangle_soup.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// View samples on surfaces in place of a camera's pixels: at texels of a lightmap, or at vertices.
namespace penumbra::visibility {

/// A point of a triangle (its number in the scene) by the shares of its three corners in the soup's order, which add up
/// to 1. kBackground: no point.
struct SurfacePoint {
  std::int32_t triangle = ViewSamples::kBackground;
  glm::dvec3 shares{0};
};

enum class SurfaceSide : std::uint8_t {
  front,  ///< from which the soup's corners run counter-clockwise
  back,
};

/// The view sample of each point, `camera.width` in a row. p is the sum of the scene's stored float32 corners by their
/// shares, in double, rounded once; n and `facing` are those of the triangle's plane on the chosen side, exactly; depth
/// is the distance from the camera's eye along its axis, of which nothing depends. Points of triangles without area
/// become background. `soup`: the scene's triangles with their own order of corners.
ViewSamples surface_view_samples(const SceneFloats& scene, std::span<const mesh::Triangle> soup,
                                 const PinholeCamera& camera, std::span<const SurfacePoint> points, SurfaceSide side);

/// The texels of a lightmap whose centres triangles cover.
struct TexelPoints {
  std::vector<SurfacePoint> points;  ///< row by row from the top left
  std::uint64_t covered = 0;
  std::uint64_t overlaps = 0;  ///< how often a centre lay inside a further triangle: the first one has it
  std::uint64_t outside = 0;   ///< triangles that leave the unit square
  std::uint64_t unmapped = 0;  ///< triangles without finite coordinates, or without area there
};

/// `triangles` are numbers into `soup`; `places` has the coordinates of each position in the lightmap, (0, 0) its top
/// left, (1, 1) its bottom right. The centre of texel (x, y) lies at ((x + ½) / width, (y + ½) / height). A centre on
/// an edge is covered, so that no crack opens between neighbours: their common edge has one sign, computed from its
/// ends in lexicographic order. Of several triangles that cover a centre, the first has it.
TexelPoints texel_points(std::span<const mesh::Triangle> soup, std::span<const std::uint32_t> triangles,
                         std::span<const glm::dvec2> places, std::uint32_t width, std::uint32_t height);

/// For each texel the covered texel whose value it shows: itself, or, up to `margin` texels around what is covered, the
/// nearest by steps to one of eight neighbours, in rows and columns first; others −1.
std::vector<std::int64_t> margin_sources(std::span<const SurfacePoint> points, std::uint32_t width,
                                         std::uint32_t margin);

}  // namespace penumbra::visibility
