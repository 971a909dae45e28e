// SPDX-License-Identifier: Apache-2.0
// Separates occluders from receivers and fits a window to each (Atty et al. 2006).

#include "maps/backprojection/soft_shadow_map/soft_scene.hpp"

#include "visibility/receivers.hpp"
#include "visibility/tree/view_walk.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace penumbra::maps {
namespace {

/// Directions beyond this tangent (76°) are left out of a window.
constexpr double kWidestTangent = 4;

struct Bounds {
  glm::dvec2 lower{kWidestTangent}, upper{-kWidestTangent};
  bool any = false;

  void add(const glm::dvec3& corner) {
    // A corner at or beyond the light's plane has the widest direction.
    const double z = std::max(corner.z, 0.0);
    for (int axis = 0; axis < 2; ++axis) {
      const double at =
          std::abs(corner[axis]) < kWidestTangent * z ? corner[axis] / z : std::copysign(kWidestTangent, corner[axis]);
      lower[axis] = std::min(lower[axis], at);
      upper[axis] = std::max(upper[axis], at);
    }
    any = true;
  }
};

double farthest(const visibility::SceneFloats& scene, const glm::dvec3& x) {
  return glm::length(glm::max(glm::abs(glm::dvec3(scene.lower) - x), glm::abs(glm::dvec3(scene.upper) - x)));
}

}  // namespace

SoftScene part_scene(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis) {
  const std::size_t count = scene.triangles.size();
  const auto casts = [&](std::size_t i) { return scene.casts_shadow[i] != 0 && scene.emits[i] != light.index; };
  const auto receives = [&](std::size_t i) {
    return visibility::is_receiver(scene, light, static_cast<std::uint32_t>(i));
  };
  std::map<std::uint32_t, bool> casting;   // objects that receive: true if any of their triangles casts
  std::map<std::uint32_t, double> facing;  // area of the objects toward the light
  // A triangle without area is not visible, and must not influence the separation.
  for (const std::uint32_t i : visibility::triangles_with_area(scene)) {
    if (!receives(i)) continue;
    casting[scene.object[i]] |= casts(i);
    const auto corners = scene.corners(i);
    const glm::dvec3 a = basis.local(corners[0]), b = basis.local(corners[1]), c = basis.local(corners[2]);
    const glm::dvec3 middle = (a + b + c) / 3.0;
    if (middle.z < 0 && !light.two_sided) continue;
    const double distance = glm::length(middle);
    if (distance > 0) facing[scene.object[i]] += std::abs(glm::dot(glm::cross(b - a, c - a), middle)) / (2 * distance);
  }
  const bool some_only_receive = std::ranges::any_of(casting, [](const auto& object) { return !object.second; });
  std::uint32_t largest = 0;
  double area = -1;
  for (const auto& [object, here] : facing) {
    if (here > area) {
      area = here;
      largest = object;
    }
  }
  SoftScene parts{std::vector<std::uint8_t>(count, 0), std::vector<std::uint8_t>(count, 0)};
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_receiver =
        receives(i) && (some_only_receive ? !casting[scene.object[i]] : scene.object[i] == largest);
    parts.receivers[i] = is_receiver ? 1 : 0;
    parts.occluders[i] = !is_receiver && casts(i) ? 1 : 0;
  }
  return parts;
}

gpu::LightView fit_window(const visibility::SceneFloats& scene, const LightBasis& basis,
                          std::span<const std::uint8_t> chosen, std::uint32_t size, bool two_sided) {
  gpu::LightView view{};
  view.point = glm::vec3(basis.center);
  view.far = static_cast<float>(std::max(farthest(scene, basis.center) * 1.0625, 1e-30));
  std::uint32_t faces = 0;
  for (int s = 0; s < (two_sided ? 2 : 1); ++s) {
    Bounds bounds;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (chosen[i] == 0) continue;
      std::array<glm::dvec3, 3> local;
      const auto corners = scene.corners(static_cast<std::uint32_t>(i));
      std::ranges::transform(corners, local.begin(), [&](const glm::vec3& corner) {
        const glm::dvec3 at = basis.local(corner);
        return glm::dvec3(at.x, at.y, s == 0 ? at.z : -at.z);
      });
      const auto in_front = std::ranges::count_if(local, [](const glm::dvec3& corner) { return corner.z > 0; });
      if (in_front == 0) continue;
      if (in_front < 3) {  // the triangle reaches the light's plane, and may be seen in any direction
        for (const double sign : {-1.0, 1.0}) bounds.add({sign, sign, 0});
      } else {
        for (const glm::dvec3& corner : local) bounds.add(corner);
      }
    }
    view.side[s].first_face = faces;
    if (!bounds.any) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const double texel = std::max((bounds.upper[axis] - bounds.lower[axis]) / (size - 2), kWidestTangent * 0x1p-20);
      view.side[s].lower[axis] = static_cast<float>(bounds.lower[axis] - texel);
      view.side[s].upper[axis] = static_cast<float>(bounds.upper[axis] + texel);
    }
    view.side[s].face_count = 1;
    ++faces;
  }
  return view;
}

}  // namespace penumbra::maps
