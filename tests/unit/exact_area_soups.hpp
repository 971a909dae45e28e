// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/exact_area_scenes.hpp"

#include <glm/geometric.hpp>

#include <random>
#include <vector>

namespace penumbra::tests {

/// Returns triangles on a coarse lattice between, around, above and below the floor (at −1) and the light (at 3): many
/// share vertices and edges, cross, coincide, touch the plane of p or of the light, or have no area.
inline std::vector<Corners> lattice_soup(std::mt19937& random, int count, double step = 0.5) {
  std::vector<Corners> soup;
  const auto corner = [&] {
    return glm::dvec3(random_dyadic(random, -2, 2, step), random_dyadic(random, -1.5, 3.5, step),
                      random_dyadic(random, -2, 2, step));
  };
  while (static_cast<int>(soup.size()) < count) {
    const Corners corners{corner(), corner(), corner()};
    // Pairs of a strip: the next triangle shares two corners.
    soup.push_back(corners);
    soup.push_back({corners[1], corners[2], corner()});
  }
  return soup;
}

enum class Lamp { flat, tilted, polygon, disk, ellipse, sphere };

inline scenes::Scene soup_scene(const std::vector<Corners>& soup, Lamp lamp) {
  scenes::Scene scene = area_scene(soup, -1);
  scene.lights.push_back(ceiling_light(3, 1));
  if (lamp == Lamp::tilted) scene.lights[0] = rectangle_light({0.25, 2.5, 0}, {1, 0.25, 0.125}, {0.25, 0.5, 1});
  if (lamp == Lamp::polygon)
    scene.lights[0].shape = scenes::Polygon{{{-1, 3, -1}, {1, 3, -0.5}, {1.25, 3, 0.5}, {0, 3, 1}}};
  if (lamp == Lamp::disk) scene.lights[0].shape = scenes::Disk{{0, 3, 0}, {0.125, -1, 0.25}, 0.75};
  if (lamp == Lamp::ellipse) scene.lights[0].shape = scenes::Ellipse{{0, 3, 0.25}, {1, 0.25, 0}, {0.25, 0, 0.5}};
  if (lamp == Lamp::sphere) scene.lights[0].shape = scenes::Sphere{{0.25, 2.5, 0}, 0.75};
  return scene;
}

/// Returns the position of a receiver; a third of them lie on the lattice of the corners.
inline glm::vec3 soup_receiver(std::mt19937& random) {
  const double step = std::uniform_int_distribution<int>(0, 2)(random) == 0 ? 0.5 : 1.0 / 64;
  return {random_dyadic(random, -2, 2, step), -1, random_dyadic(random, -2, 2, step)};
}

}  // namespace penumbra::tests
