// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scenes for properties that every method must have: shipped ones, meshes with every defect, and soups on a small
// lattice, where a camera, a light and triangles coincide.

#include "mesh/shapes/broken_meshes.hpp"
#include "scenes/formats/reader.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/analytic/maps/fixture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {

struct Place {
  std::string name;
  Stage stage, shuffled;
};

/// Returns the scene with objects and triangles in another order, and some triangles wound in the opposite direction.
inline scenes::Scene shuffled(const scenes::Scene& scene, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto order_of = [&](std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::shuffle(order, random);
    return order;
  };
  scenes::Scene turned = scene;
  const std::vector<std::size_t> triangles = order_of(scene.soup.triangles.size()),
                                 objects = order_of(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) turned.objects[objects[i]] = scene.objects[i];
  for (scenes::AreaLight& light : turned.lights) {
    for (std::uint32_t& object : light.unshaded_by) object = static_cast<std::uint32_t>(objects[object]);
    std::ranges::sort(light.unshaded_by);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    auto corners = scene.soup.triangles[triangles[i]];
    if (random() % 2 == 0) std::swap(corners[0], corners[1 + random() % 2]);
    turned.soup.triangles[i] = corners;
    turned.soup.object[i] = static_cast<std::uint32_t>(objects[scene.soup.object[triangles[i]]]);
  }
  return turned;
}

inline Place place_of(const std::string& name, const scenes::Scene& scene, std::uint32_t side,
                      const visibility::SampleRequest& request) {
  return {name, Stage(scene, side, side, request), Stage(shuffled(scene, side), side, side, request)};
}

inline Place lattice_place(std::uint32_t seed, std::uint32_t side) {
  LatticeSoup soup(seed, 2);
  visibility::SampleRequest request;
  const scenes::Scene scene = lattice_scene(soup, request);
  return place_of(fmt::format("lattice {}", seed), scene, side, request);
}

inline Place soup_place(std::uint32_t seed, std::uint32_t side) {
  const mesh::LatticeSoup soup{.triangles = 40, .cells = 3, .seed = seed, .center = {0, 1, 0}};
  return place_of(fmt::format("soup {}", seed), with_a_floor(mesh::make_lattice_soup(soup)), side, light_samples(9));
}

inline Place broken_place(const std::vector<std::string>& defects, std::uint32_t side) {
  return place_of(fmt::format("broken mesh of {} defects, {} first", defects.size(), defects.front()),
                  with_a_floor(mesh::make_broken_mesh({defects, 1, {0, 1, 0}, 1}).soup), side, light_samples(16));
}

inline std::vector<std::string> all_defects() {
  std::vector<std::string> defects;
  for (const mesh::DefectName& defect : mesh::broken_defects()) defects.emplace_back(defect.name);
  return defects;
}

inline Place shipped_place(const std::string& file, std::uint32_t side) {
  return place_of(file, scenes::read_scene(std::filesystem::path(PENUMBRA_SCENES) / file), side, light_samples(16));
}

/// Returns one place of each kind.
inline const std::vector<Place>& few_places() {
  static const std::vector<Place> all = [] {
    std::vector<Place> made;
    made.push_back(shipped_place("self-shadow.json", 12));
    made.push_back(broken_place(all_defects(), 12));
    made.push_back(soup_place(1, 10));
    made.push_back(lattice_place(5, 10));
    return made;
  }();
  return all;
}

/// Visits, one after the other, all shipped scenes that are small enough, a mesh for each defect, and many soups.
inline void each_place(const std::function<void(const Place&)>& see) {
  for (const char* file : {"self-shadow.json", "bunny.json", "contact.json", "fusion.json", "large-penumbra.json",
                           "parallel-square.json", "room.json", "thin.json", "broken.json"}) {
    see(shipped_place(file, 24));
  }
  see(broken_place(all_defects(), 24));
  for (const std::string& defect : all_defects()) see(broken_place({defect}, 10));
  for (std::uint32_t seed = 1; seed <= 6; ++seed) see(soup_place(seed, 14));
  for (std::uint32_t seed = 1; seed <= 40; ++seed) see(lattice_place(seed, 10));
}

}  // namespace penumbra::tests
