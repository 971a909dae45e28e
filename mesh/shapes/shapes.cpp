// SPDX-License-Identifier: Apache-2.0
// Generates boxes, rings and other shapes with known properties.

#include "mesh/shapes/shapes.hpp"

#include "base/assert.hpp"
#include "mesh/shapes/shape_builder.hpp"

#include <glm/geometric.hpp>

#include <numeric>
#include <unordered_map>
#include <utility>

namespace penumbra::mesh {
namespace builder {

std::uint32_t add_box_corners(TriangleSoup& soup, const glm::dvec3& low, const glm::dvec3& high) {
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    add_vertex(soup, {(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                      (corner & 4) != 0 ? high.z : low.z});
  }
  return first;
}

void add_box(TriangleSoup& soup, const glm::dvec3& low, const glm::dvec3& high) {
  const std::uint32_t first = add_box_corners(soup, low, high);
  for (const auto& side : kBoxSides) {
    add_quad(soup, first + side[0], first + side[1], first + side[2], first + side[3]);
  }
}

void append(TriangleSoup& soup, const TriangleSoup& other) {
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

void add_ring_faces(TriangleSoup& soup, std::uint32_t segments, std::uint32_t sides) {
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t row = i * sides, next_row = (i + 1) % segments * sides;
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t next = (j + 1) % sides;
      add_quad(soup, row + j, row + next, next_row + next, next_row + j);
    }
  }
}

TriangleSoup finish(TriangleSoup soup) {
  soup.object.assign(soup.triangles.size(), 0);
  soup.source_face.resize(soup.triangles.size());
  std::iota(soup.source_face.begin(), soup.source_face.end(), 0u);
  return soup;
}

}  // namespace builder

using namespace builder;

TriangleSoup make_quad(const glm::dvec3& center, const glm::dvec3& half_u, const glm::dvec3& half_v) {
  TriangleSoup soup;
  soup.positions = {center - half_u - half_v, center + half_u - half_v, center + half_u + half_v,
                    center - half_u + half_v};
  add_quad(soup, 0, 1, 2, 3);
  return finish(std::move(soup));
}

ShapeSize shape_size(const GridShape& grid) {
  return checked({2ull * grid.cells_u * grid.cells_v, (grid.cells_u + 1ull) * (grid.cells_v + 1ull)});
}

TriangleSoup make_grid(const GridShape& grid) {
  PENUMBRA_ASSERT(grid.cells_u > 0 && grid.cells_v > 0, "{} x {}", grid.cells_u, grid.cells_v);
  TriangleSoup soup = soup_with_room(shape_size(grid));
  for (std::uint32_t j = 0; j <= grid.cells_v; ++j) {
    for (std::uint32_t i = 0; i <= grid.cells_u; ++i) {
      const double u = 2.0 * i / grid.cells_u - 1, v = 2.0 * j / grid.cells_v - 1;
      add_vertex(soup, grid.center + u * grid.half_u + v * grid.half_v);
    }
  }
  const std::uint32_t row = grid.cells_u + 1;
  for (std::uint32_t j = 0; j < grid.cells_v; ++j) {
    for (std::uint32_t i = 0; i < grid.cells_u; ++i) {
      const std::uint32_t corner = j * row + i;
      add_quad(soup, corner, corner + 1, corner + row + 1, corner + row);
    }
  }
  return finish(std::move(soup));
}

TriangleSoup make_box(const glm::dvec3& center, const glm::dvec3& half_size) {
  TriangleSoup soup;
  add_box(soup, center - half_size, center + half_size);
  return finish(std::move(soup));
}

ShapeSize shape_size(const SphereShape& sphere) {
  const std::uint64_t around = std::uint64_t{sphere.segments} * (sphere.rings - 1);
  return checked({2 * around, around + 2});
}

TriangleSoup make_sphere(const SphereShape& sphere) {
  const std::uint32_t segments = sphere.segments, rings = sphere.rings;
  PENUMBRA_ASSERT(segments >= 3 && rings >= 2, "{} segments, {} rings", segments, rings);
  TriangleSoup soup = soup_with_room(shape_size(sphere));
  const std::uint32_t top = add_vertex(soup, sphere.center + glm::dvec3(0, sphere.radius, 0));
  for (std::uint32_t i = 1; i < rings; ++i) {
    const double latitude = std::numbers::pi * i / rings;  // measured from the upper pole
    for (std::uint32_t j = 0; j < segments; ++j) {
      const double longitude = kTau * j / segments;
      const glm::dvec3 direction(std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                                 -std::sin(latitude) * std::sin(longitude));
      add_vertex(soup, sphere.center + sphere.radius * direction);
    }
  }
  const std::uint32_t bottom = add_vertex(soup, sphere.center - glm::dvec3(0, sphere.radius, 0));
  const auto ring_vertex = [&](std::uint32_t ring, std::uint32_t j) {
    return 1 + (ring - 1) * segments + j % segments;
  };
  for (std::uint32_t j = 0; j < segments; ++j) {
    soup.triangles.push_back({top, ring_vertex(1, j), ring_vertex(1, j + 1)});
  }
  for (std::uint32_t i = 1; i + 1 < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      add_quad(soup, ring_vertex(i, j), ring_vertex(i + 1, j), ring_vertex(i + 1, j + 1), ring_vertex(i, j + 1));
    }
  }
  for (std::uint32_t j = 0; j < segments; ++j) {
    soup.triangles.push_back({ring_vertex(rings - 1, j), bottom, ring_vertex(rings - 1, j + 1)});
  }
  return finish(std::move(soup));
}

ShapeSize icosphere_size(std::uint32_t subdivisions) {
  PENUMBRA_ASSERT(subdivisions < 16, "{}", subdivisions);
  const std::uint64_t parts = 1ull << (2 * subdivisions);  // triangles of each of the icosahedron's sides
  return checked({20 * parts, 10 * parts + 2});
}

TriangleSoup make_icosphere(const glm::dvec3& center, double radius, std::uint32_t subdivisions) {
  require_room(icosphere_size(subdivisions));
  // The icosahedron's corners are the cyclic permutations of (0, ±1, ±golden ratio).
  const double g = std::numbers::phi;
  TriangleSoup soup;
  soup.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  soup.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (glm::dvec3& position : soup.positions) position = glm::normalize(position);
  for (std::uint32_t level = 0; level < subdivisions; ++level) {
    std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
      const std::uint64_t edge = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
      const auto [found, is_new] = midpoints.try_emplace(edge, static_cast<std::uint32_t>(soup.positions.size()));
      if (is_new) add_vertex(soup, glm::normalize(soup.positions[a] + soup.positions[b]));
      return found->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(soup.triangles.size() * 4);
    for (const auto [a, b, c] : soup.triangles) {
      const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
      finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}});
    }
    soup.triangles = std::move(finer);
  }
  for (glm::dvec3& position : soup.positions) position = center + radius * position;
  return finish(std::move(soup));
}

ShapeSize shape_size(const CylinderShape& cylinder) {
  const std::uint64_t segments = cylinder.segments;
  return checked(cylinder.capped ? ShapeSize{4 * segments, 2 * segments + 2} : ShapeSize{2 * segments, 2 * segments});
}

TriangleSoup make_cylinder(const CylinderShape& cylinder) {
  const std::uint32_t segments = cylinder.segments;
  PENUMBRA_ASSERT(segments >= 3, "{}", segments);
  TriangleSoup soup = soup_with_room(shape_size(cylinder));
  const glm::dvec3 up(0, cylinder.height / 2, 0);
  for (std::uint32_t j = 0; j < segments; ++j) {
    const double angle = kTau * j / segments;
    const glm::dvec3 rim = cylinder.center + cylinder.radius * glm::dvec3(std::cos(angle), 0, -std::sin(angle));
    add_vertex(soup, rim - up);
    add_vertex(soup, rim + up);
  }
  for (std::uint32_t j = 0; j < segments; ++j) {
    const std::uint32_t low = 2 * j, next = 2 * ((j + 1) % segments);
    add_quad(soup, low, next, next + 1, low + 1);
  }
  if (cylinder.capped) {
    const std::uint32_t bottom = add_vertex(soup, cylinder.center - up), top = add_vertex(soup, cylinder.center + up);
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t low = 2 * j, next = 2 * ((j + 1) % segments);
      soup.triangles.push_back({bottom, next, low});
      soup.triangles.push_back({top, low + 1, next + 1});
    }
  }
  return finish(std::move(soup));
}

ShapeSize cone_size(const CylinderShape& cone) {
  return checked({2ull * cone.segments, cone.segments + 2ull});
}

TriangleSoup make_cone(const CylinderShape& cone) {
  const std::uint32_t segments = cone.segments;
  PENUMBRA_ASSERT(segments >= 3 && cone.capped, "{}", segments);
  TriangleSoup soup = soup_with_room(cone_size(cone));
  const glm::dvec3 up(0, cone.height / 2, 0);
  for (std::uint32_t j = 0; j < segments; ++j) {
    const double angle = kTau * j / segments;
    add_vertex(soup, cone.center - up + cone.radius * glm::dvec3(std::cos(angle), 0, -std::sin(angle)));
  }
  const std::uint32_t bottom = add_vertex(soup, cone.center - up), tip = add_vertex(soup, cone.center + up);
  for (std::uint32_t j = 0; j < segments; ++j) {
    const std::uint32_t next = (j + 1) % segments;
    soup.triangles.push_back({j, next, tip});
    soup.triangles.push_back({bottom, next, j});
  }
  return finish(std::move(soup));
}

ShapeSize shape_size(const TorusShape& torus) {
  return checked({2ull * torus.segments * torus.sides, std::uint64_t{torus.segments} * torus.sides});
}

TriangleSoup make_torus(const TorusShape& torus) {
  PENUMBRA_ASSERT(torus.segments >= 3 && torus.sides >= 3, "{} x {}", torus.segments, torus.sides);
  TriangleSoup soup = soup_with_room(shape_size(torus));
  for (std::uint32_t i = 0; i < torus.segments; ++i) {
    const double around = kTau * i / torus.segments;
    const glm::dvec3 outward(std::cos(around), 0, -std::sin(around));
    for (std::uint32_t j = 0; j < torus.sides; ++j) {
      const double across = -kTau * j / torus.sides;  // counter-clockwise about the direction of growing i
      const double distance = torus.radius + torus.tube * std::cos(across);
      add_vertex(soup, torus.center + distance * outward + glm::dvec3(0, torus.tube * std::sin(across), 0));
    }
  }
  add_ring_faces(soup, torus.segments, torus.sides);
  return finish(std::move(soup));
}

}  // namespace penumbra::mesh
