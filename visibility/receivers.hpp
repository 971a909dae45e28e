// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>

namespace penumbra::visibility {

/// Returns whether a triangle receives shadows of a light (Light::index). False for the light's own body and for
/// objects that receive no shadows: there V = 1, regardless of casters.
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, std::int32_t light, std::uint32_t triangle) {
  return scene.emits[triangle] != light && scene.receives_shadow[triangle] != 0;
}
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, const Light& light, std::uint32_t triangle) {
  return is_receiver(scene, light.index, triangle);
}

/// Returns whether the light lights this triangle's object (a mesh's `lights`).
[[nodiscard]] inline bool is_lit_by(const SceneFloats& scene, const Light& light, std::uint32_t triangle) {
  return light.unlit.empty() || light.unlit[scene.object[triangle]] == 0;
}

/// Returns whether the surface that a pixel shows receives shadows of the light; false for background.
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, std::int32_t light, const ViewSamples& samples,
                                      std::size_t pixel) {
  const std::int32_t carrier = samples.triangle[pixel];
  return carrier != ViewSamples::kBackground && is_receiver(scene, light, static_cast<std::uint32_t>(carrier));
}
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, const Light& light, const ViewSamples& samples,
                                      std::size_t pixel) {
  return is_receiver(scene, light.index, samples, pixel);
}

}  // namespace penumbra::visibility
