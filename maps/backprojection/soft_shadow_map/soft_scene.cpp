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
#include <cstddef>
#include <limits>
#include <map>

namespace penumbra::maps {
namespace {

/// Directions beyond this tangent (76°) are left out of a window.
constexpr double kWidestTangent = 4;

struct Bounds {
  glm::dvec2 lower{kWidestTangent}, upper{-kWidestTangent};
  double nearest = std::numeric_limits<double>::infinity(), deepest = 0;  ///< z
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
    nearest = std::min(nearest, z);
    deepest = std::max(deepest, z);
    any = true;
  }
};

double farthest(const visibility::SceneFloats& scene, const glm::dvec3& x) {
  return glm::length(glm::max(glm::abs(glm::dvec3(scene.lower) - x), glm::abs(glm::dvec3(scene.upper) - x)));
}

/// Returns the bounds of the chosen triangles on one side of the light's plane.
Bounds bounds_of(const visibility::SceneFloats& scene, const LightBasis& basis, std::span<const std::uint8_t> chosen,
                 double sign) {
  Bounds bounds;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] == 0) continue;
    std::array<glm::dvec3, 3> local;
    const auto corners = scene.corners(static_cast<std::uint32_t>(i));
    std::ranges::transform(corners, local.begin(), [&](const glm::vec3& corner) {
      const glm::dvec3 at = basis.local(corner);
      return glm::dvec3(at.x, at.y, sign * at.z);
    });
    const auto in_front = std::ranges::count_if(local, [](const glm::dvec3& corner) { return corner.z > 0; });
    if (in_front == 0) continue;
    if (in_front < 3) {  // the triangle reaches the light's plane, and may be seen in any direction
      for (const double side : {-1.0, 1.0}) bounds.add({side, side, 0});
    } else {
      for (const glm::dvec3& corner : local) bounds.add(corner);
    }
  }
  return bounds;
}

/// Returns the width of a texel of a map with these bounds and a margin of one texel all around.
glm::dvec2 texel_of(const Bounds& bounds, std::uint32_t size) {
  return glm::max((bounds.upper - bounds.lower) / (size - 2.0), glm::dvec2(kWidestTangent * 0x1p-20));
}

/// Returns the view whose windows have these bounds and a margin of one texel all around.
gpu::LightView view_of(const visibility::SceneFloats& scene, const LightBasis& basis,
                       const std::array<Bounds, 2>& sides, std::uint32_t size, bool snap) {
  gpu::LightView view{};
  view.point = glm::vec3(basis.center);
  view.far = static_cast<float>(std::max(farthest(scene, basis.center) * 1.0625, 1e-30));
  std::uint32_t faces = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const Bounds& bounds = sides.at(s);
    view.side[s].first_face = faces;
    if (!bounds.any) continue;
    const glm::dvec2 texel = texel_of(bounds, size);
    for (int axis = 0; axis < 2; ++axis) {
      double lower = bounds.lower[axis] - texel[axis], upper = bounds.upper[axis] + texel[axis];
      if (snap) {
        const SnappedSpan span = snapped(lower, upper, size);
        lower = span.lower;
        upper = span.lower + span.texel * size;
      }
      view.side[s].lower[axis] = static_cast<float>(lower);
      view.side[s].upper[axis] = static_cast<float>(upper);
    }
    view.side[s].face_count = 1;
    ++faces;
  }
  return view;
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
  std::array<Bounds, 2> sides;
  for (std::size_t s = 0; s < (two_sided ? 2U : 1U); ++s)
    sides.at(s) = bounds_of(scene, basis, chosen, s == 0 ? 1 : -1);
  return view_of(scene, basis, sides, size, false);
}

SoftViews fit_to_camera(const visibility::SceneFloats& scene, const LightBasis& basis, const SoftScene& parts,
                        const SoftBody& body) {
  std::array<Bounds, 2> receivers, occluders;
  for (std::size_t s = 0; s < (body.two_sided ? 2U : 1U); ++s) {
    const double sign = s == 0 ? 1 : -1;
    Bounds& seen = receivers.at(s);
    for (const BodyPoint& point : body.points) {
      const glm::dvec3 at = basis.local(point.p);
      if (sign * at.z > 0) seen.add({at.x, at.y, sign * at.z});
    }
    if (!seen.any) continue;
    occluders.at(s) = bounds_of(scene, basis, parts.occluders, sign);
    Bounds& shading = occluders.at(s);
    if (!shading.any) continue;
    // An occluder at height z_c shades a receiver at height z up to a distance of reach · (1/z_c − 1/z) from the
    // receiver, and V is interpolated from texels up to one away from the receiver's.
    const glm::dvec2 texel = texel_of(seen, body.receiver_size);
    const double closer = std::max(0.0, 1 / std::max(shading.nearest, 0.0) - 1 / seen.deepest);
    for (int axis = 0; axis < 2; ++axis) {
      const double beside = 2 * texel[axis] + (body.reach[axis] > 0 ? body.reach[axis] * closer : 0);
      shading.lower[axis] = std::max(shading.lower[axis], seen.lower[axis] - beside);
      shading.upper[axis] = std::min(shading.upper[axis], seen.upper[axis] + beside);
      if (shading.lower[axis] > shading.upper[axis]) shading.any = false;
    }
  }
  return {view_of(scene, basis, receivers, body.receiver_size, body.snap),
          view_of(scene, basis, occluders, body.occluder_size, body.snap)};
}

}  // namespace penumbra::maps
