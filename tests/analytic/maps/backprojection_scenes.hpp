// SPDX-License-Identifier: Apache-2.0
#pragma once
// Small scenes for methods that project maps back onto the light. The light is at height 5, the floor at 0, and casters
// in between receive nothing, so that every receiver is well below all casters.

#include "tests/analytic/maps/fixture.hpp"

#include <fmt/format.h>

#include <numbers>

namespace penumbra::tests {

inline scenes::Scene bare_floor(double light_half, double floor_half = 2) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {floor_half, 0, 0}, {0, 0, -floor_half}).casts_shadow = false;
  scene.soup.positions.emplace_back(0, 4.5, 0);  // above all casters, so that the origin does not depend on them
  scene.lights.push_back(ceiling_light(5, light_half));
  scene.cameras.push_back(camera({0, 4, 4}, {0, 0, 0}));
  return scene;
}

/// A grid of `side` × `side` view samples over the floor, which a camera above the casters would not see.
inline Stage on_floor(const scenes::Scene& scene, std::uint32_t side, const visibility::SampleRequest& request) {
  const auto grid = [side](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    double half = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      half = std::max(half, static_cast<double>(floats.positions[i].x) + floats.origin.x);
    }
    const auto corners = floats.corners(0);
    const bool up = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y > 0;
    visibility::ViewSamples samples;
    samples.width = samples.height = side;
    for (std::uint32_t i = 0; i < side * side; ++i) {
      const glm::dvec2 at = (glm::dvec2(i % side, i / side) + 0.5) / static_cast<double>(side) * 2.0 - 1.0;
      samples.triangle.push_back(0);
      samples.p.emplace_back(glm::dvec3(half * at.x, 0, half * at.y) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(up ? 1 : -1);
    }
    return samples;
  };
  return {scene, side, side, request, grid};
}

/// View samples on the floor at these x, slightly off the middle in z.
inline Stage along_floor(const scenes::Scene& scene, const std::vector<double>& places,
                         const visibility::SampleRequest& request) {
  const auto line = [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    const auto corners = floats.corners(0);
    const bool up = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y > 0;
    visibility::ViewSamples samples;
    samples.width = static_cast<std::uint32_t>(places.size());
    samples.height = 1;
    for (const double x : places) {
      samples.triangle.push_back(0);
      samples.p.emplace_back(glm::dvec3(x, 0, 0.013) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(up ? 1 : -1);
    }
    return samples;
  };
  return {scene, static_cast<std::uint32_t>(places.size()), 1, request, line};
}

/// A sphere: one closed convex body.
inline scenes::Scene sphere_over_floor(double light_half = 1, int rings = 16, double scale = 1) {
  scenes::Scene scene = bare_floor(light_half, 3);
  add_object(scene, "sphere", sphere({0, 2, 0}, scale, rings)).receives_shadow = false;
  return scene;
}

/// A small square above a large plate: light gets between them (Bavoil et al. 2006, figure 1).
inline scenes::Scene square_above_plate() {
  scenes::Scene scene = bare_floor(0.6);
  add_quad(scene, {0, 3.5, 0}, {0.3, 0, 0}, {0, 0, -0.3}).receives_shadow = false;
  add_quad(scene, {0, 1.5, 0}, {1.6, 0, 0}, {0, 0, -1.6}).receives_shadow = false;
  return scene;
}

/// An oblique quad, turned in its plane's map by `turn`.
inline scenes::Scene oblique_quad(double turn = 0) {
  scenes::Scene scene = bare_floor(0.6);
  const double c = std::cos(turn), s = std::sin(turn);
  add_quad(scene, {0, 2.5, 0}, {c, -1.2 * c, s}, {-s, 1.2 * s, c}).receives_shadow = false;
  return scene;
}

/// Two plates that look the same to the light's centre in both variants: with a gap that other points of the light see
/// through (`gap`), or without one.
inline scenes::Scene plates_with_gap(bool gap) {
  scenes::Scene scene = bare_floor(0.6);
  add_quad(scene, {-1, 3.5, 0}, {1, 0, 0}, {0, 0, -2}).receives_shadow = false;
  if (gap) {
    add_quad(scene, {1, 1.5, 0}, {1, 0, 0}, {0, 0, -2}).receives_shadow = false;
  } else {
    add_quad(scene, {0, 1.5, 0}, {2, 0, 0}, {0, 0, -2}).receives_shadow = false;
  }
  return scene;
}

/// An upright box, moved by `aside` in x.
inline scenes::Scene box_over_floor(double aside = 0, double light_half = 0.5) {
  scenes::Scene scene = bare_floor(light_half);
  const auto side = [&](const glm::dvec3& at, const glm::dvec3& u, const glm::dvec3& v) {
    add_quad(scene, glm::dvec3(aside, 1.5, 0) + at, u, v).receives_shadow = false;
  };
  const glm::dvec3 x(0.4, 0, 0), y(0, 1, 0), z(0, 0, 0.4);
  side(x, y, z);
  side(-x, y, z);
  side(y, z, x);
  side(-y, z, x);
  side(z, x, y);
  side(-z, x, y);
  return scene;
}

/// Nine bars, each `width` wide.
inline scenes::Scene bars(double width, double light_half = 0.4) {
  scenes::Scene scene = bare_floor(light_half, 1.2);
  for (int k = -4; k <= 4; ++k) {
    add_quad(scene, {0.2 * k + 0.013, 2.5, 0}, {width / 2, 0, 0}, {0, 0, -1}).receives_shadow = false;
  }
  return scene;
}

}  // namespace penumbra::tests
