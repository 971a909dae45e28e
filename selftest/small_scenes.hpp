// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small scenes made by hand, for the self-test and the tests.

#include "scenes/scene.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::selftest {

using Corners = std::array<glm::dvec3, 3>;

/// Adds a new object of the given triangles, each with its own vertices.
inline scenes::Object& add_object(scenes::Scene& scene, std::string name, const std::vector<Corners>& triangles) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  for (const Corners& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
    scene.soup.positions.insert(scene.soup.positions.end(), corners.begin(), corners.end());
    scene.soup.source_face.push_back(static_cast<std::uint32_t>(scene.soup.source_face.size()));
    scene.soup.triangles.push_back({first, first + 1, first + 2});
    scene.soup.object.push_back(object);
  }
  scene.objects.emplace_back();
  scene.objects.back().name = std::move(name);
  return scene.objects.back();
}

inline std::vector<Corners> quad(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  const glm::dvec3 a = center - u - v, b = center + u - v, c = center + u + v, d = center - u + v;
  return {{a, b, c}, {a, c, d}};
}

inline scenes::Object& add_quad(scenes::Scene& scene, const glm::dvec3& center, const glm::dvec3& u,
                                const glm::dvec3& v) {
  return add_object(scene, "quad", quad(center, u, v));
}

/// Returns a sphere of `rings` × 2 `rings` faces.
inline std::vector<Corners> sphere(const glm::dvec3& center, double radius, int rings) {
  const auto at = [&](int i, int j) {
    const double theta = std::numbers::pi * i / rings, phi = std::numbers::pi * j / rings;
    return center +
           radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  std::vector<Corners> faces;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (i + 1 < rings) faces.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return faces;
}

inline scenes::AreaLight rectangle_light(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  scenes::AreaLight light;
  light.name = "key";
  light.shape = scenes::Rectangle{center, u, v};
  return light;
}

/// Returns a square light of half-size `half` at height `height` over the y axis, facing down.
inline scenes::AreaLight ceiling_light(double height, double half) {
  return rectangle_light({0, height, 0}, {half, 0, 0}, {0, 0, half});
}

inline scenes::Camera camera(const glm::dvec3& eye, const glm::dvec3& target, double fov = 45) {
  scenes::Camera result;
  result.name = "camera";
  result.eye = eye;
  result.target = target;
  result.vertical_fov = fov;
  return result;
}

/// Returns a request of `count` light samples, with defaults for the other options.
inline visibility::SampleRequest light_samples(std::uint32_t count) {
  visibility::SampleRequest request;
  request.count = count;
  return request;
}

/// Input of visibility, for the first camera and light of a scene.
struct Stage {
  Stage(const scenes::Scene& scene, std::uint32_t width, std::uint32_t height,
        const visibility::SampleRequest& request = {})
      : Stage(scene, width, height, request, visibility::brute_force_view_samples) {}
  /// Uses the view samples found by `view(floats, pinhole)`.
  template <typename View>
  Stage(const scenes::Scene& scene, std::uint32_t width, std::uint32_t height, const visibility::SampleRequest& request,
        const View& view)
      : floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin, request)),
        pinhole(visibility::make_camera(scene.cameras.front(), floats.origin, width, height)),
        samples(view(floats, pinhole)) {}

  visibility::SceneFloats floats;
  visibility::Light light;
  visibility::PinholeCamera pinhole;
  visibility::ViewSamples samples;
};

}  // namespace penumbra::selftest
