// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scenes under a dome, and the methods that support domes, without a device.

#include "base/error.hpp"
#include "reference/methods.hpp"
#include "render/machine.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"
#include "vsm/methods.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {

inline scenes::AreaLight dome_light(const scenes::Dome& dome = {}) {
  scenes::AreaLight light;
  light.name = "sky";
  light.shape = dome;
  light.radiance = glm::dvec3(1);
  return light;
}

using MadeMethod = std::unique_ptr<visibility::Method>;

/// Returns the methods that give masks.
inline std::vector<std::pair<std::string, MadeMethod>> dome_mask_methods() {
  const render::Machine machine;
  std::vector<std::pair<std::string, MadeMethod>> methods;
  methods.emplace_back("edge-scatter", volumes::make_edge_scatter(machine, {{"engine", "native"}}));
  methods.emplace_back("view-sample", vsm::make_view_sample(machine, {{"engine", "native"}}));
  methods.emplace_back("depth-complexity", volumes::make_depth_complexity(machine, {{"engine", "native"}}));
  return methods;
}

/// Returns the methods that give areas.
inline std::vector<std::pair<std::string, MadeMethod>> dome_area_methods() {
  std::vector<std::pair<std::string, MadeMethod>> methods;
  methods.emplace_back("rows=exact", volumes::make_edge_scatter(render::Machine(), {{"rows", "exact"}}));
  methods.emplace_back("exact", reference::make_exact({}));
  return methods;
}

/// Masks, or form factors, of a whole picture.
struct DomeAnswer {
  Masks masks;
  std::vector<glm::dvec3> form_factors;
};
inline DomeAnswer answer_of(visibility::Method& method, const visibility::SceneFloats& floats,
                            const visibility::Light& light, const visibility::ViewSamples& samples) {
  method.want_form_factors(true);
  method.prepare_mesh(floats);
  method.prepare_light(light);
  method.prepare_view(samples);
  const bool gives_masks = method.description().output == visibility::Output::mask;
  const bool gives_area = method.description().gives_area();
  DomeAnswer answer;
  answer.masks.words_per_pixel = gives_masks ? light.words_per_mask() : 0;
  answer.masks.words.resize(samples.size() * answer.masks.words_per_pixel);
  answer.masks.visibility.resize(samples.size());
  answer.form_factors.resize(gives_area ? samples.size() : 0);
  for (std::uint32_t first = 0; first < samples.height;) {
    const std::uint32_t rows = std::min(method.max_tile_rows(), samples.height - first);
    method.evaluate({first, rows});
    const std::size_t pixel = std::size_t{first} * samples.width, pixels = std::size_t{rows} * samples.width;
    const std::size_t words = answer.masks.words_per_pixel;
    if (gives_masks) method.read_masks(std::span(answer.masks.words).subspan(pixel * words, pixels * words));
    if (gives_area) method.read_form_factors(std::span(answer.form_factors).subspan(pixel, pixels));
    method.read_visibility(std::span(answer.masks.visibility).subspan(pixel, pixels));
    first += rows;
  }
  return answer;
}
inline DomeAnswer answer_of(visibility::Method& method, const Stage& stage) {
  return answer_of(method, stage.floats, stage.light, stage.samples);
}

}  // namespace penumbra::tests
