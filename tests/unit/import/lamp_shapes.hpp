// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace penumbra::test {

/// Emitters as a modeller makes them: points, and triangles that run counter-clockwise as seen from the side that
/// emits.
struct LampMesh {
  std::vector<glm::dvec3> points;
  std::vector<mesh::Triangle> triangles;

  /// Adds a flat polygon as a fan around its first corner.
  void add(const std::vector<glm::dvec3>& corners) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), corners.begin(), corners.end());
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({first, first + i, first + i + 1});
  }
  void turn() {
    for (mesh::Triangle& t : triangles) std::swap(t[1], t[2]);
  }
  [[nodiscard]] glm::dvec3 vector_area(const mesh::Triangle& t) const {
    return glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) / 2.0;
  }
  [[nodiscard]] double area() const {
    double sum = 0;
    for (const mesh::Triangle& t : triangles) sum += glm::length(vector_area(t));
    return sum;
  }
};

/// Makes a cube with side × side quads on each face; faces do not share corners.
inline LampMesh cube_lamp(const glm::dvec3& center, double half, int side = 1) {
  LampMesh lamp;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 n(0), u(0), v(0);
      n[axis] = sign * half;
      u[(axis + 1) % 3] = half;
      v[(axis + 2) % 3] = sign * half;
      for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) {
          const auto at = [&](int s, int t) {
            return center + n + (2.0 * s / side - 1) * u + (2.0 * t / side - 1) * v;
          };
          lamp.add({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
        }
      }
    }
  }
  return lamp;
}

/// Makes a tube along x, open at both ends or closed by polygons.
inline LampMesh tube_lamp(const glm::dvec3& center, double radius, double half, int sides, bool closed) {
  const auto at = [&](int i, double x) {
    const double angle = 2 * std::numbers::pi * (i % sides) / sides;
    return center + glm::dvec3(x, radius * std::cos(angle), radius * std::sin(angle));
  };
  LampMesh lamp;
  std::vector<glm::dvec3> front, back;
  for (int i = 0; i < sides; ++i) {
    lamp.add({at(i, half), at(i, -half), at(i + 1, -half), at(i + 1, half)});
    front.push_back(at(i, half));
    back.push_back(at(sides - i, -half));
  }
  if (closed) lamp.add(front), lamp.add(back);
  return lamp;
}

/// Makes a star with the given number of points, facing down, as triangles around its middle.
inline LampMesh star_lamp(const glm::dvec3& center, double outer, double inner, int points) {
  LampMesh lamp;
  lamp.points.push_back(center);
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points, r = i % 2 == 0 ? outer : inner;
    lamp.points.push_back(center + glm::dvec3(r * std::cos(angle), 0, r * std::sin(angle)));
  }
  const auto count = static_cast<std::uint32_t>(2 * points);
  for (std::uint32_t i = 0; i < count; ++i) lamp.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
  return lamp;
}

/// Makes two separate rectangles, one facing down and one upright.
inline LampMesh two_panels(const glm::dvec3& center) {
  LampMesh lamp;
  const glm::dvec3 a = center - glm::dvec3(1, 0, 0), b = center + glm::dvec3(1, 0, 0);
  lamp.add({a + glm::dvec3(-0.5, 0, -0.3), a + glm::dvec3(0.5, 0, -0.3), a + glm::dvec3(0.5, 0, 0.3),
            a + glm::dvec3(-0.5, 0, 0.3)});  // faces down
  lamp.add({b + glm::dvec3(0, -0.4, -0.3), b + glm::dvec3(0, -0.4, 0.3), b + glm::dvec3(0, 0.4, 0.3),
            b + glm::dvec3(0, 0.4, -0.3)});  // faces −x
  return lamp;
}

/// Makes an icosahedron whose triangles are cut in four `subdivisions` times.
inline LampMesh ball_lamp(const glm::dvec3& center, double radius, int subdivisions) {
  const double t = std::numbers::phi;
  LampMesh lamp;
  lamp.points = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                 {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  lamp.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(lamp.points.size()));
      if (is_new) lamp.points.push_back(glm::normalize(lamp.points[a]) + glm::normalize(lamp.points[b]));
      return entry->second;
    };
    std::vector<mesh::Triangle> finer;
    for (const auto& [a, b, c] : lamp.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      const std::array<mesh::Triangle, 4> four = {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
      finer.insert(finer.end(), four.begin(), four.end());
    }
    lamp.triangles = std::move(finer);
  }
  for (glm::dvec3& p : lamp.points) p = center + radius * glm::normalize(p);
  return lamp;
}

}  // namespace penumbra::test
