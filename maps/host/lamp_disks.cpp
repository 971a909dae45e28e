// SPDX-License-Identifier: Apache-2.0
// Replaces a sphere by disks that face pyramids of directions. Not from a paper.

#include "maps/host/lamp_disks.hpp"

#include "visibility/axes_around.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::maps {
namespace {

constexpr double kHalfFace = std::numbers::pi / 4;

/// Axes across and along a face of a cube.
struct CubeFace {
  glm::dvec3 a, b, w;
};
CubeFace cube_face(std::uint32_t number) {
  CubeFace face{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
  const auto axis = static_cast<glm::length_t>(number / 2);
  face.w[axis] = number % 2 == 0 ? 1 : -1;
  face.a[(axis + 1) % 3] = 1;
  face.b[(axis + 2) % 3] = 1;
  return face;
}

/// Returns the tangent at which cut `cut` of a face begins; exactly ∓1 at its borders.
double tangent_of(std::uint32_t cut) {
  if (cut == 0) return -1;
  if (cut == LampDisks::kCuts) return 1;
  return std::tan(kHalfFace * (2.0 * cut / LampDisks::kCuts - 1));
}

std::uint32_t cut_of(double tangent) {
  std::uint32_t cut = 0;
  while (cut + 1 < LampDisks::kCuts && tangent >= tangent_of(cut + 1)) ++cut;
  return cut;
}

}  // namespace

std::uint32_t LampDisks::number_of(const glm::vec3& p) const {
  const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(sphere_->center), far = glm::abs(d);
  glm::length_t axis = 0;
  if (far.y > far[axis]) axis = 1;
  if (far.z > far[axis]) axis = 2;
  if (far[axis] == 0) return 0;
  const std::uint32_t number = 2 * static_cast<std::uint32_t>(axis) + (d[axis] > 0 ? 0 : 1);
  const CubeFace face = cube_face(number);
  const std::uint32_t x = cut_of(glm::dot(d, face.a) / far[axis]), y = cut_of(glm::dot(d, face.b) / far[axis]);
  return (number * kCuts + y) * kCuts + x;
}

visibility::Light LampDisks::disk(std::uint32_t number) const {
  const std::uint32_t x = number % kCuts, y = number / kCuts % kCuts;
  const CubeFace face = cube_face(number / (kCuts * kCuts));
  const glm::dvec2 lower(tangent_of(x), tangent_of(y)), upper(tangent_of(x + 1), tangent_of(y + 1));
  const glm::dvec2 middle = glm::tan(0.5 * (glm::atan(lower) + glm::atan(upper)));
  const glm::dvec3 normal = glm::normalize(middle.x * face.a + middle.y * face.b + face.w);
  const visibility::Axes axes = visibility::axes_around(normal);
  const glm::dvec3 center(sphere_->center), u = sphere_->radius * axes.u, v = sphere_->radius * axes.v;

  visibility::Light disk = *sphere_;
  disk.kind = visibility::LightKind::disk;
  disk.two_sided = false;
  disk.center_u = center + u;
  disk.center_v = center + v;
  disk.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
  disk.points.clear();
  for (const glm::dvec2& at : disk.coordinates) disk.points.emplace_back(center + at.x * u + at.y * v);
  disk.beam = visibility::Light::Beam{face.a, face.b, face.w, lower, upper};
  return disk;
}

}  // namespace penumbra::maps
