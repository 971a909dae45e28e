#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// What lies on a light. Light samples are stored in float32, up to a unit in the last place off the light's plane:
/// in front of or behind a triangle that lies in that plane, or ends in it. Methods that leave out what is not in front
/// of the plane cannot know which; they leave such light samples to the exact decision.
struct LightTouch {
  /// A view sample whose height over the light's plane is less than this share of its distance from the farthest light
  /// sample sees what is near the plane from so flat that any light sample may be concerned, if something is near.
  static constexpr double kFlat = 1.0 / 256;

  std::vector<std::uint32_t> samples;  ///< light samples that something touches, ascending
  bool any_near = false;               ///< something is in the light's plane where flat ways may meet it

  [[nodiscard]] bool empty() const { return samples.empty() && !any_near; }
};

/// Of any light but a sphere. A triangle touches a light sample if, of its part within 2 δ of the light's plane, any is
/// within 1/64 + 1024 δ κ cells of it: δ bounds how far samples are off the plane (and what double rounding makes of
/// that), κ cells a length (of a grid with about as many as light samples, where those form none). From a view sample
/// that is not flat (kFlat), the way to a light sample moves sideways by no more than 3 · 256 δ between its end and a
/// height of 2 δ; from the flattest that are not open as a whole (bound level), by 2²² δ.
LightTouch find_touch(const SceneFloats& scene, const TriangleTree& tree, const Light& light);

}  // namespace penumbra::visibility
