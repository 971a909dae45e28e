// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

/// Small soups with known answers, for tests of the half-edge view and of repair.
namespace penumbra::mesh::test {

inline MeshView view(const TriangleSoup& soup) {
  return {soup.positions, soup.triangles};
}

inline TriangleSoup soup_of(std::vector<glm::dvec3> positions, std::vector<Triangle> triangles) {
  TriangleSoup soup{std::move(positions), std::move(triangles), {}, {}};
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    soup.object.push_back(t % 3);
    soup.source_face.push_back(t);
  }
  return soup;
}

/// Returns twelve triangles with eight positions, wound counter-clockwise as seen from outside.
inline TriangleSoup box(const glm::dvec3& low = {0, 0, 0}, const glm::dvec3& size = {1, 1, 1}) {
  std::vector<glm::dvec3> positions;
  for (int i = 0; i < 8; ++i) positions.push_back(low + size * glm::dvec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  return soup_of(positions, {{0, 2, 3},
                             {0, 3, 1},
                             {4, 5, 7},
                             {4, 7, 6},
                             {0, 1, 5},
                             {0, 5, 4},
                             {2, 6, 7},
                             {2, 7, 3},
                             {0, 4, 6},
                             {0, 6, 2},
                             {1, 3, 7},
                             {1, 7, 5}});
}

inline TriangleSoup together(const TriangleSoup& a, const TriangleSoup& b) {
  TriangleSoup both = a;
  const auto offset = static_cast<std::uint32_t>(a.positions.size());
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  for (std::size_t t = 0; t < b.triangles.size(); ++t) {
    const Triangle& i = b.triangles[t];
    both.triangles.push_back({i[0] + offset, i[1] + offset, i[2] + offset});
    both.object.push_back(b.object[t]);
    both.source_face.push_back(b.source_face[t]);
  }
  return both;
}

/// Returns the soup with separate positions for every triangle, as in an STL file.
inline TriangleSoup shattered(const TriangleSoup& soup) {
  TriangleSoup pieces{{}, {}, soup.object, soup.source_face};
  for (const Triangle& t : soup.triangles) {
    const auto first = static_cast<std::uint32_t>(pieces.positions.size());
    for (const std::uint32_t i : t) pieces.positions.push_back(soup.positions[i]);
    pieces.triangles.push_back({first, first + 1, first + 2});
  }
  return pieces;
}

inline TriangleSoup without_triangle(TriangleSoup soup, std::size_t t) {
  const auto at = static_cast<std::ptrdiff_t>(t);
  soup.triangles.erase(soup.triangles.begin() + at);
  soup.object.erase(soup.object.begin() + at);
  soup.source_face.erase(soup.source_face.begin() + at);
  return soup;
}

/// Returns a band of `cells` quads with a half turn in it: no winding of all its triangles agrees everywhere.
inline TriangleSoup moebius(std::uint32_t cells) {
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < cells; ++i) {
    const double turn = 2 * 3.14159265358979 * i / cells;
    for (const double side : {-1.0, 1.0}) {
      const double r = 4 + side * std::cos(turn / 2);
      positions.emplace_back(r * std::cos(turn), r * std::sin(turn), side * std::sin(turn / 2));
    }
    const bool last = i + 1 == cells;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    triangles.push_back({a, c, b});
    triangles.push_back({b, c, d});
  }
  return soup_of(positions, triangles);
}

/// Returns triangles with corners drawn from {0 … cells}³: coincidences are the rule.
inline TriangleSoup lattice_soup(std::uint32_t seed, std::uint32_t triangles, int cells) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(0, cells);
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> indices;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (int i = 0; i < 3; ++i) positions.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    indices.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return soup_of(positions, indices);
}

}  // namespace penumbra::mesh::test
