#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>

namespace penumbra::visibility {

/// Who receives shadow: not the body of a light, nor what says that it does not. There V = 1, whatever casts.
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, std::uint32_t triangle) {
  return scene.emits[triangle] < 0 && scene.receives_shadow[triangle] != 0;
}

/// Does the light light this triangle's object (a mesh's `lights`)?
[[nodiscard]] inline bool is_lit_by(const SceneFloats& scene, const Light& light, std::uint32_t triangle) {
  return light.unlit.empty() || light.unlit[scene.object[triangle]] == 0;
}

/// Does the surface that a pixel shows receive shadow? Background does not.
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, const ViewSamples& samples, std::size_t pixel) {
  const std::int32_t carrier = samples.triangle[pixel];
  return carrier != ViewSamples::kBackground && is_receiver(scene, static_cast<std::uint32_t>(carrier));
}

}  // namespace penumbra::visibility
