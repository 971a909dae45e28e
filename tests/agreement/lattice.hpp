// SPDX-License-Identifier: Apache-2.0
#pragma once

// Soups whose corners, light samples and cameras lie on a small integer lattice: coincidences are the rule. Cases that
// rounding hides elsewhere (an edge exactly through a light sample, a view sample exactly on another triangle's plane,
// doubles, coplanar neighbours, triangles without area) occur here all the time.

#include "tests/unit/visibility/scenes.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <utility>
#include <vector>

namespace penumbra::tests {

class LatticeSoup {
 public:
  /// Corners in −range … range.
  LatticeSoup(std::uint32_t seed, int range) : random_(seed), range_(range) {}

  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  int coordinate() { return static_cast<int>(below(static_cast<std::uint32_t>(2 * range_ + 1))) - range_; }
  glm::dvec3 point() {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }
  std::mt19937& random() { return random_; }

  /// Returns `count` triangles, each in one of these relations to an earlier one: none, its double (turned and
  /// flipped), a neighbour at an edge, a coplanar neighbour, without area, on a plane of the lattice.
  std::vector<Corners> triangles(std::uint32_t count) {
    std::vector<Corners> soup;
    while (soup.size() < count) {
      Corners corners{point(), point(), point()};
      const Corners old = soup.empty() ? corners : soup[below(static_cast<std::uint32_t>(soup.size()))];
      switch (below(10)) {
        case 0:
          corners = old;
          break;
        case 1:
          corners = {old[1], old[0], old[2]};
          break;
        case 2:
        case 3:
          corners = {old[1], old[0], corners[2]};
          break;
        case 4:
          corners = {old[1], old[2], old[1] + old[2] - old[0]};
          break;  // completes a parallelogram
        case 5:
          corners[2] = below(2) == 0 ? corners[0] : 2.0 * corners[1] - corners[0];
          break;
        case 6:
          corners[0].y = corners[1].y = corners[2].y;
          break;
        case 7:
          corners[0].x = corners[1].x = corners[2].x;
          break;
        default:
          break;
      }
      soup.push_back(corners);
    }
    return soup;
  }

  /// Returns a rectangle around a lattice point whose samples (3×3, 5×5, 3×5 or 1×3 of pattern grid) lie on the
  /// lattice. It is sometimes inside the soup, sometimes above it, mostly parallel to an axis; sometimes two-sided.
  scenes::AreaLight light(visibility::SampleRequest& request) {
    static constexpr std::pair<std::uint32_t, std::uint32_t> kLayouts[] = {{3, 3}, {5, 5}, {3, 5}, {1, 3}};
    const auto [rows, columns] = kLayouts[below(4)];
    request = {rows * columns, rows, columns, visibility::SamplePattern::grid, 0};
    static const std::pair<glm::dvec3, glm::dvec3> steps[] = {
        {{1, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {1, 0, 0}},  {{1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {1, 0, 0}},
        {{1, 1, 0}, {0, 0, 1}}, {{1, 0, 1}, {1, 0, -1}}, {{1, 1, 0}, {-1, 1, 1}}};
    const auto [u, v] = steps[below(std::size(steps))];
    glm::dvec3 center = point();
    if (below(2) == 0) center.y = range_ + 1.0 + below(3);
    scenes::AreaLight result = rectangle_light(center, 0.5 * columns * u, 0.5 * rows * v);
    result.two_sided = below(3) == 0;
    return result;
  }

 private:
  std::mt19937 random_;
  int range_;
};

/// Returns a scene of three objects: one of plain triangles, one that casts no shadow, and the light's body: the light
/// itself as a quad, and a few triangles elsewhere.
inline scenes::Scene lattice_scene(LatticeSoup& soup, visibility::SampleRequest& request) {
  scenes::Scene scene;
  scene.lights.push_back(soup.light(request));
  add_object(scene, "plain", soup.triangles(6 + soup.below(20)));
  add_object(scene, "casts none", soup.triangles(soup.below(4))).casts_shadow = false;
  if (soup.below(2) == 0) {
    std::vector<Corners> body = soup.triangles(soup.below(3));
    const auto& shape = std::get<scenes::Rectangle>(scene.lights[0].shape);
    const std::vector<Corners> itself = quad(shape.center, shape.half_u, shape.half_v);
    body.insert(body.end(), itself.begin(), itself.end());
    add_object(scene, "body", body).emits = 0;
  }
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 eye = 2.0 * soup.point(), target = soup.point();
    if (eye == target) eye.z += 5;
    const bool along_y = eye.x == target.x && eye.z == target.z;
    scene.cameras.push_back(camera(eye, target, 70));
    if (along_y) scene.cameras.back().up = {1, 0, 0};
  }
  return scene;
}

}  // namespace penumbra::tests
