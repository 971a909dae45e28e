// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// Triangles that touch a light. Light samples are stored in float32, up to a unit in the last place off the light's
/// plane: they may be in front of or behind a triangle that lies in that plane, or ends in it. Methods that skip
/// triangles not in front of the plane cannot decide this; they leave such light samples to the exact decision.
struct LightTouch {
  /// A view sample whose height over the light's plane is less than this fraction of its distance from the farthest
  /// light sample sees the plane at such a small angle that objects close to the plane may affect any light sample.
  static constexpr double kFlat = 1.0 / 256;

  std::vector<std::uint32_t> samples;  ///< light samples that some triangle touches, ascending
  bool any_near = false;               ///< a triangle is close to the light's plane where flat segments may meet it

  [[nodiscard]] bool empty() const { return samples.empty() && !any_near; }
};

/// Finds the touched samples of any light but a sphere. A triangle touches a light sample if a part of it within 2 δ of
/// the light's plane is within 1/64 + 1024 δ κ cells of the sample: δ bounds the samples' distance from the plane (and
/// its rounding in double), κ is the number of cells in a unit of length (of a grid with about as many cells as light
/// samples, if these are not in rows). From a view sample that is not flat (kFlat), the segment to a light sample moves
/// sideways by at most 3 · 256 δ between its end and a height of 2 δ; from the flattest view samples whose side of the
/// light is certain (bound level of docs/view-sample.md), by 2²² δ.
LightTouch find_touch(const SceneFloats& scene, const TriangleTree& tree, const Light& light);

}  // namespace penumbra::visibility
