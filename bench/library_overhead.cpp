// SPDX-License-Identifier: Apache-2.0
// Prints the time that a call of the library takes beyond the phases in the picture's statistics, as JSON with a row
// for each case.
//   library_overhead [SIDE [CALLS]]
// A kept renderer renders square pictures of a box over a floor, SIDE pixels wide. Between calls either nothing
// changes, or the light, the box or the camera moves. Times are medians of CALLS calls after four discarded ones.

#include <penumbra/penumbra.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr int kDiscarded = 4;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Adds the box [-1, 1] × [0, 2] × [-1, 1]. The bits of a corner's index give its x, y and z; faces are oriented
/// outward.
penumbra::MeshId add_box(penumbra::Scene& scene) {
  std::vector<penumbra::Vector> corners(8);
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = {(i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 2.0 : 0.0, (i & 4U) != 0 ? 1.0 : -1.0};
  const std::vector<std::array<std::uint32_t, 3>> faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                           {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                           {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return scene.add_mesh("box", corners, faces);
}

void add_floor(penumbra::Scene& scene) {
  const std::vector<penumbra::Vector> corners = {{-6, 0, -6}, {6, 0, -6}, {6, 0, 6}, {-6, 0, 6}};
  scene.add_mesh("floor", corners, std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 3, 2}});
}

penumbra::Rectangle light_at(double x) {
  return {.center = {x, 5, 1}, .half_u = {0.5, 0, 0}, .half_v = {0, 0, 0.5}};
}

/// Case: a change of the scene before each call.
struct Case {
  std::string name;
  std::function<void(penumbra::Scene& scene, penumbra::MeshId box, double offset)> change;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"nothing", [](penumbra::Scene&, penumbra::MeshId, double) {}},
      {"the light moves",
       [](penumbra::Scene& scene, penumbra::MeshId, double offset) { scene.set_light("key", light_at(offset)); }},
      {"the box moves",
       [](penumbra::Scene& scene, penumbra::MeshId box, double offset) {
         scene.set_transform(box, {1, 0, 0, offset, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
       }},
      {"the camera moves", [](penumbra::Scene& scene, penumbra::MeshId, double offset) {
         scene.set_camera({.eye = {4 + offset, 4, 5}, .target = {0, 1, 0}, .vertical_fov = 45});
       }}};
  return all;
}

/// Measures one case. `samples`: light samples, by the method that the library chooses; 0: exact areas.
nlohmann::json measured(const Case& one, std::uint32_t samples, std::uint32_t side, int calls) {
  penumbra::Scene scene;
  add_floor(scene);
  const penumbra::MeshId box = add_box(scene);
  scene.add_light("key", light_at(0), {.radiance = {10, 10, 10}});
  scene.set_camera({.eye = {4, 4, 5}, .target = {0, 1, 0}, .vertical_fov = 45});
  penumbra::Renderer renderer(std::move(scene));
  std::vector<double> whole, phases, beyond;
  std::string method;
  for (int i = 0; i < kDiscarded + calls; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    one.change(renderer.scene(), box, 0.01 * i);
    const penumbra::Picture picture = renderer.render({.width = side, .height = side, .light_samples = samples});
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - begin;
    if (i < kDiscarded) continue;
    method = picture.method();
    const nlohmann::json seconds = nlohmann::json::parse(picture.stats_json())["seconds"];
    double sum = 0;  // null: did not run; shadow is light and evaluate together
    for (const char* phase : {"load", "mesh", "view", "light", "evaluate", "beauty", "write"})
      sum += seconds[phase].is_number() ? 1e3 * seconds[phase].get<double>() : 0;
    whole.push_back(wall.count());
    phases.push_back(sum);
    beyond.push_back(wall.count() - sum);
  }
  const auto rounded = [](double milliseconds) { return std::round(1e3 * milliseconds) / 1e3; };
  return {{"changes", one.name},
          {"method", method},
          {"lightSamples", samples},
          {"call", rounded(median(whole))},
          {"phases", rounded(median(phases))},
          {"beyond", rounded(median(beyond))}};
}

}  // namespace

int main(int count, char** words) {
  const int side = count > 1 ? std::atoi(words[1]) : 64, calls = count > 2 ? std::atoi(words[2]) : 101;
  if (side <= 0 || calls <= 0) {
    std::cerr << "usage: library_overhead [SIDE [CALLS]]\n";
    return 2;
  }
  try {
    nlohmann::json rows = nlohmann::json::array();
    for (const std::uint32_t samples : {0U, 256U}) {
      for (const Case& one : cases()) rows.push_back(measured(one, samples, static_cast<std::uint32_t>(side), calls));
    }
    std::cout << rows.dump(1) << '\n';
  } catch (const std::exception& error) {
    std::cerr << "library_overhead: " << error.what() << '\n';
    return 3;
  }
  return 0;
}
