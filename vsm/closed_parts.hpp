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

/// The parts (at most kMost, the largest) whose triangles meet two at an edge and can be wound alike, none of them
/// coplanar with any triangle elsewhere, none the body of a light.
struct ClosedParts {
  static constexpr std::uint32_t kMost = 31;
  static constexpr std::uint32_t kFewestTriangles = 64;

  std::vector<ClosedPart> parts;
  std::vector<std::uint8_t> part;  ///< for each triangle: its part's number, from 1, or 0. Empty when there is none
  std::vector<std::int8_t> turn;   ///< for each triangle of a part: ±1, so that turned by it all normals point inward
};

/// Scene floats know no winding, and none is needed: parts are wound here.
ClosedParts find_closed_parts(const visibility::SceneFloats& scene);

/// Bit k: the box of part k (from 1) is certainly apart from the light's. Only these parts have dispensable triangles.
/// `frame` is scaled by `scale`.
std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::DeviceLight& frame, float scale);
/// Likewise of a sphere, and of a sun, which is apart from all.
std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::Light& light);

/// For each triangle that certainly has the whole light in front, wound by `turn`, and so is dispensable to view
/// samples outside its part (docs/view-sample.md, "Closed casters"): the part's number, else 0.
std::vector<std::uint8_t> find_dispensable(const ClosedParts& closed, const visibility::SceneFloats& scene,
                                           const visibility::DeviceLight& frame, float scale);

}  // namespace penumbra::vsm
