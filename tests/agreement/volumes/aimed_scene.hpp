// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scenes made for one bound at a time: a small light somewhere in a scene with coordinates up to 1, an occluder aimed
// by the test that includes this header, and view samples close together around p on a floor that casts no shadow.

#include "tests/agreement/support.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::tests {

class Draws {
 public:
  explicit Draws(std::uint32_t seed) : random_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double power(double low, double high) { return std::pow(10.0, real(low, high)); }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 d(real(-1, 1), real(-1, 1), real(-1, 1));
      if (glm::length(d) > 0.1 && glm::length(d) < 1) return glm::normalize(d);
    }
  }
  glm::dvec3 across(const glm::dvec3& n) { return glm::normalize(glm::cross(n, direction())); }

 private:
  std::mt19937_64 random_;
};

struct OneLightScene {
  visibility::SceneFloats floats;
  visibility::Light light;
  visibility::ViewSamples samples;

  OneLightScene(const scenes::LightShape& shape, const visibility::SampleRequest& request) : request_(request) {
    scenes::Object& anchor = add_object(scene_, "anchor", {{glm::dvec3(-1), glm::dvec3(1), glm::dvec3(1, -1, 1)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    scene_.lights.push_back(ceiling_light(1, 1));
    scene_.lights[0].shape = shape;
    scene_.lights[0].two_sided = true;
    look();
  }

  void add_occluder(const std::vector<Corners>& triangles) { add_object(scene_, "occluder", triangles); }

  /// Adds 64 view samples within `spread` of p, on a floor perpendicular to `up` that extends as far as `size`.
  void look_from(Draws& aim, const glm::dvec3& p, const glm::dvec3& up, double size, double spread) {
    const glm::dvec3 a = aim.across(up), b = glm::cross(up, a);
    add_object(scene_, "floor", {{p - size * a - size * b, p + size * a - size * b, p + size * b}}).casts_shadow =
        false;
    look();
    const auto carrier = static_cast<std::int32_t>(floats.triangles.size() - 1);
    const auto [c0, c1, c2] = floats.corners(static_cast<std::uint32_t>(carrier));
    const glm::dvec3 normal = glm::cross(glm::dvec3(c1) - glm::dvec3(c0), glm::dvec3(c2) - glm::dvec3(c0));
    const glm::dvec3 center = glm::dvec3(light.center) + floats.origin;
    const std::int8_t facing = glm::dot(normal, center - p) > 0 ? 1 : -1;
    samples.width = samples.height = 8;
    for (int i = 0; i < 64; ++i) {
      samples.triangle.push_back(carrier);
      samples.p.emplace_back(p + spread * (aim.real(-1, 1) * a + aim.real(-1, 1) * b) - floats.origin);
      samples.n.emplace_back(static_cast<double>(facing) * glm::normalize(normal));
      samples.depth.push_back(1);
      samples.facing.push_back(facing);
    }
  }

 private:
  void look() {
    floats = visibility::make_scene_floats(scene_);
    light = visibility::make_light(scene_, 0, floats.origin, request_);
  }

  visibility::SampleRequest request_;
  scenes::Scene scene_;
};

}  // namespace penumbra::tests
