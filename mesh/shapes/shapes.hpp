// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

/// Generated meshes with known properties: the number of triangles is a formula, closed shapes are watertight
/// two-manifolds with normals outward, and equal parameters give equal numbers. Y is up. Every triangle is its own face
/// (source_face = its index) and belongs to object 0.
///
/// Throws InputError for an impossible shape (a window wider than its wall, more than kMaxShapeTriangles).
namespace penumbra::mesh {

inline constexpr std::uint64_t kMaxShapeTriangles = 50'000'000;

/// Size of a shape. shape_size(…) returns it before the shape is made, so that costs can be estimated.
struct ShapeSize {
  std::uint64_t triangles = 0, vertices = 0;
};

/// Makes 2 triangles, facing half_u × half_v.
TriangleSoup make_quad(const glm::dvec3& center, const glm::dvec3& half_u, const glm::dvec3& half_v);

struct GridShape {
  glm::dvec3 center{0}, half_u{1, 0, 0}, half_v{0, 0, -1};
  std::uint32_t cells_u = 16, cells_v = 16;
};
/// Makes a quad cut into cells: 2 · cells_u · cells_v triangles.
TriangleSoup make_grid(const GridShape& grid);
ShapeSize shape_size(const GridShape& grid);

/// Makes a closed box of 12 triangles.
TriangleSoup make_box(const glm::dvec3& center, const glm::dvec3& half_size);

struct SphereShape {
  glm::dvec3 center{0};
  double radius = 1;
  std::uint32_t segments = 32;  ///< around the Y axis
  std::uint32_t rings = 16;     ///< from pole to pole
};
/// Makes a sphere of latitudes and longitudes: 2 · segments · (rings − 1) triangles, closed.
TriangleSoup make_sphere(const SphereShape& sphere);
ShapeSize shape_size(const SphereShape& sphere);

/// Makes a subdivided icosahedron: 20 · 4^subdivisions triangles, closed.
TriangleSoup make_icosphere(const glm::dvec3& center, double radius, std::uint32_t subdivisions);
ShapeSize icosphere_size(std::uint32_t subdivisions);

struct BlobShape {
  glm::dvec3 center{0};
  double radius = 1;
  std::uint32_t subdivisions = 5;
  double bump = 0.2;     ///< depth of the bumps as a fraction of the radius, below 1
  double frequency = 5;  ///< approximate number of bumps around the circumference
};
/// Makes a bumpy icosphere that shadows itself: 20 · 4^subdivisions triangles, closed, star-shaped about its centre.
TriangleSoup make_blob(const BlobShape& blob);
ShapeSize shape_size(const BlobShape& blob);

struct CylinderShape {
  glm::dvec3 center{0};  ///< the middle of the axis
  double radius = 1, height = 2;
  std::uint32_t segments = 32;
  bool capped = true;
};
/// Makes a cylinder along Y: 4 · segments triangles and closed, or 2 · segments without caps.
TriangleSoup make_cylinder(const CylinderShape& cylinder);
ShapeSize shape_size(const CylinderShape& cylinder);

/// Makes a cone along Y, tip up; `center` is the middle of the axis. 2 · segments triangles, closed (`capped` must be
/// true).
TriangleSoup make_cone(const CylinderShape& cone);
ShapeSize cone_size(const CylinderShape& cone);

struct TorusShape {
  glm::dvec3 center{0};
  double radius = 1, tube = 0.25;  ///< from the centre to the tube's axis; of the tube itself
  std::uint32_t segments = 48, sides = 24;
};
/// Makes a torus around the Y axis: 2 · segments · sides triangles, closed.
TriangleSoup make_torus(const TorusShape& torus);
ShapeSize shape_size(const TorusShape& torus);

struct KnotShape {
  glm::dvec3 center{0};
  double radius = 1, tube = 0.2;
  std::uint32_t turns = 2, windings = 3;  ///< around the Y axis; through the hole. Must be coprime, or the knot runs
                                          ///< several times
  std::uint32_t segments = 256, sides = 24;
};
/// Makes a torus knot: 2 · segments · sides triangles, closed.
TriangleSoup make_knot(const KnotShape& knot);
ShapeSize shape_size(const KnotShape& knot);

struct TerrainShape {
  glm::dvec3 center{0};
  glm::dvec2 half_size{5, 5};  ///< along X and Z
  double height = 1;           ///< from the lowest to the highest possible point
  glm::uvec2 cells{64, 64};    ///< along X and Z
  double features = 3;         ///< number of hills along the longer side
  std::uint32_t octaves = 6, seed = 1;
};
/// Makes fractal hills around the height of `center`: 2 · cells.x · cells.y triangles, open, facing up.
TriangleSoup make_terrain(const TerrainShape& terrain);
ShapeSize shape_size(const TerrainShape& terrain);

struct FenceShape {
  glm::dvec3 base{0};            ///< middle of the fence's bottom
  double width = 4, height = 1;  ///< along X; along Y
  double thickness = 0.03;       ///< of posts (square) and rails
  std::uint32_t posts = 21, rails = 2;
};
/// Makes posts in front of rails, each a closed box: 12 · (posts + rails) triangles.
TriangleSoup make_fence(const FenceShape& fence);
ShapeSize shape_size(const FenceShape& fence);

struct HairShape {
  glm::dvec3 base{0};             ///< middle of the patch of ground that the hair grows from
  double radius = 1, length = 1;  ///< radius of the patch; length of a strand
  double width = 0.01;            ///< width of a strand at its root; it narrows to a fifth
  double bend = 0.5;              ///< sideways lean of the tips, as a fraction of the length
  std::uint32_t strands = 200, segments = 8, seed = 1;
};
/// Makes curved strips, open on all sides: 2 · strands · segments triangles.
TriangleSoup make_hair(const HairShape& hair);
ShapeSize shape_size(const HairShape& hair);

struct RoomShape {
  glm::dvec3 base{0};                                                 ///< the middle of the floor, inside
  glm::dvec3 size{4, 2.5, 4};                                         ///< inner size
  double thickness = 0.15;                                            ///< of walls, floor and ceiling
  double window_width = 1.4, window_height = 1.2, window_sill = 0.9;  ///< the window is in the middle of the wall at −Z
  std::uint32_t vertical_bars = 1, horizontal_bars = 1;
  double bar = 0.04;  ///< thickness of the bars
};
/// Makes one watertight solid with a window through it, 44 triangles, and the window's bars, 12 triangles each.
TriangleSoup make_room(const RoomShape& room);
ShapeSize shape_size(const RoomShape& room);

struct BarsShape {
  glm::dvec3 center{0};
  double length = 2;  ///< along Z
  double spacing = 0.25, radius = 0.03;
  std::uint32_t count = 9, segments = 16;
};
/// Makes parallel round bars along X, as a grate or monkey bars: 4 · segments · count triangles, each bar closed.
TriangleSoup make_bars(const BarsShape& bars);
ShapeSize shape_size(const BarsShape& bars);

}  // namespace penumbra::mesh
