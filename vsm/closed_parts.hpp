// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::vsm {

/// A closed part of the scene, as seen from outside its box. A segment between two points outside enters the part as
/// often as it leaves it, so the triangles by which it can only enter (or only leave) need not be tested.
struct ClosedPart {
  visibility::Bounds box;
  /// Bounds of the part's vertices on each face of the box: lower x, y, z, upper x, y, z.
  std::array<visibility::Bounds, 6> touching;
};

/// The closed parts (at most kMost, the largest): their triangles meet in pairs at edges and can be wound consistently,
/// none is coplanar with any triangle elsewhere, and none is the body of a light.
struct ClosedParts {
  static constexpr std::uint32_t kMost = 31;
  static constexpr std::uint32_t kFewestTriangles = 64;

  std::vector<ClosedPart> parts;
  std::vector<std::uint8_t> part;  ///< for each triangle: the number of its part, from 1, or 0. Empty if there are no
                                   ///< parts
  std::vector<std::int8_t> turn;   ///< for each triangle of a part: ±1, so that normals multiplied by it point inward
};

/// Finds the closed parts. Scene floats have no windings, and need none: parts are wound here.
ClosedParts find_closed_parts(const visibility::SceneFloats& scene);

/// Returns a bit for each part (from 1) whose box is certainly separate from the light's. Only these parts have
/// dispensable triangles. `frame` is scaled by `scale`.
std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::DeviceLight& frame, float scale);
/// Returns the parts separate from a sphere. A sun is separate from all parts.
std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::Light& light);

/// Returns for each triangle the number of its part if the whole light is certainly in front of the triangle, wound by
/// `turn`; else 0. Such a triangle is dispensable to view samples outside of the part (docs/view-sample.md, "Closed
/// casters").
std::vector<std::uint8_t> find_dispensable(const ClosedParts& closed, const visibility::SceneFloats& scene,
                                           const visibility::DeviceLight& frame, float scale);

}  // namespace penumbra::vsm
