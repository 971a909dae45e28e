// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/every_light.hpp"
#include "reference/methods.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

/// Methods and scenes for tests of suns, spheres and surfaces with holes with methods whose maps handle only planar
/// lights and solid casters (maps/host/every_light.hpp).
namespace penumbra::tests::every_light {

using visibility::MethodOptions;

struct Entry {
  std::string name;
  Factory make;
  MethodOptions options;
  maps::Given given = {};
};

inline std::vector<Entry> all_methods(const std::string& size) {
  std::vector<Entry> all{
      {"shadow-map", maps::make_shadow_map, {}},
      {"shadow-map ids", maps::make_shadow_map, {{"test", "id"}}},
      {"pcf", maps::make_pcf, {}},
      {"pcss", maps::make_pcss, {}},
      {"vssm", maps::make_vssm, {}},
      {"convolution", maps::make_convolution, {}},
      {"occlusion-textures", maps::make_occlusion_textures, {}},
      {"bitmask", maps::make_bitmask, {}},
      {"backproject", maps::make_backproject, {}},
      {"backproject-peel", maps::make_backproject_peel, {}},
      {"contour", maps::make_contour, {}},
      {"packet", [](const auto& device, const auto& options) { return maps::make_packet(device, options); }, {}},
      {"accumulate", maps::make_accumulate, {}},
      {"soft-shadow-map", maps::make_soft_shadow_map, {}},
      {"adaptive-light", maps::make_adaptive_light, {}},
      {"deep-penumbra", maps::make_deep_penumbra, {}},
      {"layered-attenuation", maps::make_layered_attenuation, {}}};
  for (Entry& entry : all) entry.options.emplace("size", size);
  return all;
}

/// layer-rays and the methods that make penumbrae from one hard shadow, each with its entry of the family's table.
inline std::vector<Entry> foils(const std::string& size) {
  const maps::Given no_holes{.suns = true, .spheres = true, .holes = false},
      no_spheres{.suns = true, .spheres = false, .holes = true};
  std::vector<Entry> all{{"layer-rays", maps::make_layer_rays, {{"layers", "2"}}},
                         {"penumbra-map", maps::make_penumbra_map, {}, no_holes},
                         {"smoothies", maps::make_smoothies, {}, no_holes},
                         {"brabec-seidel", maps::make_brabec_seidel, {}},
                         {"kirsch-doellner", maps::make_kirsch_doellner, {}},
                         {"parker", maps::make_parker, {}},
                         {"arvo", maps::make_arvo, {}, no_spheres}};
  for (Entry& entry : all) entry.options.emplace("size", size);
  return all;
}

inline std::vector<Entry> some_methods(const std::string& size, std::initializer_list<const char*> names) {
  const std::vector<Entry> all = all_methods(size);
  std::vector<Entry> some;
  for (const char* name : names) some.push_back(*std::ranges::find(all, name, &Entry::name));
  return some;
}

class EveryLight : public MapsTest {
 protected:
  static Masks run_entry(const Entry& entry, const Stage& stage, std::uint32_t rows_at_once = 0) {
    const auto method = maps::for_every_light(entry.make(device(), entry.options), entry.given);
    return run(*method, stage, rows_at_once);
  }
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
  static double error(const Masks& found, const Masks& right) {
    double sum = 0;
    for (std::size_t i = 0; i < right.visibility.size(); ++i) {
      const double off = static_cast<double>(found.visibility[i]) - static_cast<double>(right.visibility[i]);
      sum += off * off;
    }
    return std::sqrt(sum / static_cast<double>(right.visibility.size()));
  }
};

inline constexpr std::uint32_t kCells = 4;

/// A leaf above a floor: a picture of kCells² texels, every other one a hole, repeated `times` times across a tilted
/// quad.
struct Leaf {
  glm::dvec3 center{0.1, 1, 0}, u{0.8, 0.15, 0}, v{0, 0.1, -0.8};
  double times = 1;
  scenes::PictureUse::Wrap wrap = scenes::PictureUse::Wrap::repeat;
  bool vertices = false;  ///< vertex alphas from 0 at −u to 1 at +u; opaque from 0.4 / 0.9 on

  [[nodiscard]] bool is_there(double s, double t) const {
    const auto texel = [&](double at) {
      const auto number = static_cast<int>(std::floor((at + 1) / 2 * times * kCells));
      constexpr int kCount = kCells;
      if (wrap == scenes::PictureUse::Wrap::clamp) return std::clamp(number, 0, kCount - 1);
      const int folded = (number % (2 * kCount) + 2 * kCount) % (2 * kCount);
      if (wrap == scenes::PictureUse::Wrap::repeat) return folded % kCount;
      return folded < kCount ? folded : 2 * kCount - 1 - folded;
    };
    const bool solid = (texel(s) + texel(t)) % 2 == 1;
    return solid && (!vertices || 0.9 * (s + 1) / 2 >= 0.4);
  }
  void add_to(scenes::Scene& scene) const {
    scene.looks.places.resize(scene.soup.positions.size());
    scene.looks.colors.resize(vertices ? scene.soup.positions.size() : 0, glm::vec4(1));
    scenes::Object& leaf = add_quad(scene, center, u, v);
    leaf.alpha = {scenes::Alpha::Mode::mask, vertices ? 0.9 : 1, vertices ? 0.4 : 0.5};
    leaf.picture = scenes::PictureUse{0, wrap, wrap};
    for (const glm::dvec2& at :
         {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
      scene.looks.places.push_back(times * at);
      if (vertices) scene.looks.colors.emplace_back(1, 1, 1, at.x);
    }
    scene.pictures.push_back({"leaf", kCells, kCells, {}});
    for (std::uint32_t i = 0; i < kCells * kCells; ++i)
      scene.pictures[0].texels.push_back({0, 0, 0, static_cast<std::uint8_t>((i % kCells + i / kCells) % 2 * 255)});
  }
  /// Adds the leaf's opaque texels as solid squares.
  void add_cut_out_to(scenes::Scene& scene) const {
    std::vector<Corners> squares;
    for (std::uint32_t i = 0; i < kCells * kCells; ++i) {
      const glm::dvec2 at = (glm::dvec2(i % kCells, i / kCells) + 0.5) / (kCells / 2.0) - 1.0;
      if (!is_there(at.x, at.y)) continue;
      for (const Corners& corners : quad(center + at.x * u + at.y * v, u / double{kCells}, v / double{kCells}))
        squares.push_back(corners);
    }
    add_object(scene, "quad", squares);
  }
};

inline scenes::Scene floor_under(const scenes::AreaLight& light) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {1.6, 0, 0}, {0, 0, -1.6});
  scene.soup.positions.emplace_back(0, 3, 0);  // fixes the origin, whatever stands above the floor
  scene.lights.push_back(light);
  scene.cameras.push_back(camera({0, 3, 4}, {0, 0.5, 0}));
  return scene;
}

inline scenes::AreaLight shaped(const scenes::LightShape& shape) {
  scenes::AreaLight light = ceiling_light(4, 0.3);
  light.shape = shape;
  return light;
}

/// View samples over a floor, n × n or one row along x, on the floor's first triangle.
inline auto over_floor(std::uint32_t columns, std::uint32_t rows, double middle, double half) {
  return [=](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    const auto corners = floats.corners(0);
    const bool up = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y > 0;
    visibility::ViewSamples samples;
    samples.width = columns;
    samples.height = rows;
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
      const double s = (2.0 * (i % columns) + 1) / columns - 1;
      const std::uint32_t row = i / columns;
      const double t = (2.0 * row + 1) / rows - 1;
      samples.triangle.push_back(0);
      samples.p.emplace_back(glm::dvec3(middle + half * s, 0, rows == 1 ? 0.01 : half * t) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(up ? 1 : -1);
    }
    return samples;
  };
}
inline Stage on_the_floor(const scenes::Scene& scene, std::uint32_t side, std::uint32_t samples = 64) {
  return {scene, side, side, light_samples(samples), over_floor(side, side, 0, 1.4)};
}

}  // namespace penumbra::tests::every_light
