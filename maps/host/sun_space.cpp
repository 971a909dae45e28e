// SPDX-License-Identifier: Apache-2.0
// Maps a scene under a sun to a projective space in which the sun is a disk (sun_space.hpp derives the map). Not from a
// paper.

#include "maps/host/sun_space.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace penumbra::maps {
namespace {

/// Distance of the plane Z = b, on which the map is infinite (SunSpace), below the scene, in diagonals of the scene's
/// box. With a larger distance, depths would be distorted less, but tolerances relative to a depth (a slice's end,
/// Slices) would be a larger part of the scene, and floats would lose digits.
constexpr double kScenesBelow = 4;
/// Tangent used for a sun of one direction.
constexpr double kLeastTangent = 0x1p-20;

}  // namespace

SunSpace::SunSpace(const visibility::SceneFloats& scene, const visibility::Light& sun,
                   const visibility::AllTriangles* all)
    : scene_(scene), all_(all) {
  PENUMBRA_ASSERT(sun.sun.has_value(), "light \"{}\" is no sun", sun.name);
  directions_ = *sun.sun;
  n_ = glm::normalize(glm::cross(glm::dvec3(sun.sun->axis_u), glm::dvec3(sun.sun->axis_v)));
  u_ = glm::normalize(glm::cross(glm::dvec3(sun.sun->axis_v), n_));
  v_ = glm::cross(n_, u_);
  middle_ = 0.5 * (glm::dvec3(scene.lower) + glm::dvec3(scene.upper));
  const double size = std::max(glm::length(glm::dvec3(scene.upper) - glm::dvec3(scene.lower)), 1e-30);
  scale_ = below_ = (kScenesBelow + 0.5) * size;

  scene_.origin = glm::dvec3(0);
  scene_.lower = glm::vec3(std::numeric_limits<float>::max());
  scene_.upper = -scene_.lower;
  for (glm::vec3& position : scene_.positions) {
    position = mapped(position);
    scene_.lower = glm::min(scene_.lower, position);
    scene_.upper = glm::max(scene_.upper, position);
  }
  if (all_ != nullptr) {
    for_each_positions([&](std::span<const glm::vec3> positions) {
      for (const glm::vec3& position : positions) {
        scene_.lower = glm::min(scene_.lower, position);
        scene_.upper = glm::max(scene_.upper, position);
      }
    });
  }
  if (!scene_.alphas.empty()) {
    for (const glm::vec3& position : scene.positions)
      scene_.alphas.weights.push_back(scale_ / (below_ - local(position).z));
  }

  make_light(sun);
}

void SunSpace::for_each_run(const std::function<void(const Run&)>& take) const {
  std::vector<std::array<glm::vec3, 3>> corners;
  all_->for_each_run([&](const Run& run) {
    corners.resize(run.corners.size());
    for_each_index(corners.size(), [&](std::size_t i) {
      const auto& [a, b, c] = run.corners[i];
      corners[i] = {mapped(a), mapped(b), mapped(c)};
    });
    Run here = run;
    here.corners = corners;
    take(here);
  });
}

void SunSpace::for_each_positions(const std::function<void(std::span<const glm::vec3>)>& take) const {
  std::vector<glm::vec3> mapped_positions;
  all_->for_each_positions([&](std::span<const glm::vec3> positions) {
    mapped_positions.resize(positions.size());
    for_each_index(positions.size(), [&](std::size_t i) { mapped_positions[i] = mapped(positions[i]); });
    take(mapped_positions);
  });
}

bool SunSpace::take(const visibility::Light& sun) {
  if (!sun.sun || sun.sun->axis_u != directions_.axis_u || sun.sun->axis_v != directions_.axis_v) return false;
  make_light(sun);
  return true;
}

void SunSpace::make_light(const visibility::Light& sun) {
  light_ = sun;
  const double tangent = std::max(sun.sun->tangent, kLeastTangent), radius = scale_ * tangent;
  const glm::dvec3 center(0, 0, -scale_), u(radius, 0, 0), v(0, radius, 0);
  light_.kind = visibility::LightKind::disk;
  light_.sun.reset();
  light_.two_sided = false;
  light_.radius = radius;
  light_.area = std::numbers::pi * radius * radius;
  light_.center = center;
  light_.center_u = center + u;
  light_.center_v = center + v;
  light_.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
  for (std::size_t i = 0; i < light_.points.size(); ++i) {
    const glm::dvec2 at = sun.coordinates[i];
    light_.points[i] = center + scale_ * sun.sun->tangent * glm::dvec3(at, 0);
  }
}

glm::dvec3 SunSpace::local(const glm::vec3& p) const {
  const glm::dvec3 d = glm::dvec3(p) - middle_;
  return {glm::dot(d, u_), glm::dot(d, v_), glm::dot(d, n_)};
}

/// Returned z coordinates are relative to S, so that positions keep their number of digits: the sun's plane z = 0 is at
/// −S.
glm::vec3 SunSpace::mapped(const glm::vec3& p) const {
  const glm::dvec3 at = local(p);
  const double share = scale_ / (below_ - at.z);
  return glm::vec3(share * at.x, share * at.y, share * at.z);  // S² / q − S = S Z / q, since b = S
}

/// For a mapped position p, (X, Y, Z) = p / w with w = 1 + p.z / S: w is 0 on the sun's plane, where p.z = −S.
SceneSpace SunSpace::space() const {
  glm::dmat4 to_scene(1);
  to_scene[0] = glm::dvec4(u_, 0);
  to_scene[1] = glm::dvec4(v_, 0);
  to_scene[2] = glm::dvec4(n_ + middle_ / scale_, 1 / scale_);
  to_scene[3] = glm::dvec4(middle_, 1);
  return SceneSpace(to_scene);
}

visibility::ViewSamples SunSpace::mapped(const visibility::ViewSamples& samples) const {
  visibility::ViewSamples all = samples;
  // An eye too far along the sun's light has no image in this space.
  if (below_ - local(samples.eye).z > 0) all.eye = mapped(samples.eye);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    const glm::dvec3 at = local(samples.p[i]), n(samples.n[i]);
    // The plane N · (X − P) = 0 where X = S x / z, Y = S y / z, Z = b − S² / z.
    const glm::dvec3 normal(glm::dot(n, u_), glm::dot(n, v_), glm::dot(n, n_));
    all.p[i] = mapped(samples.p[i]);
    all.n[i] = glm::vec3(
        glm::normalize(glm::dvec3(scale_ * normal.x, scale_ * normal.y, below_ * normal.z - glm::dot(normal, at))));
  }
  return all;
}

}  // namespace penumbra::maps
