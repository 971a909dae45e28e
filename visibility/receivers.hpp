#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>

namespace penumbra::visibility {

/// Who receives shadow of a light (Light::index): not its own body, nor what says that it receives none. There V = 1,
/// whatever casts.
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, std::int32_t light, std::uint32_t triangle) {
  return scene.emits[triangle] != light && scene.receives_shadow[triangle] != 0;
}
[[nodiscard]] inline bool is_receiver(const SceneFloats& scene, const Light& light, std::uint32_t triangle) {
  return is_receiver(scene, light.index, triangle);
}

/// Does the light light this triangle's object (a mesh's `lights`)?
[[nodiscard]] inline bool is_lit_by(const SceneFloats& scene, const Light& light, std::uint32_t triangle) {
  return light.unlit.empty() || light.unlit[scene.object[triangle]] == 0;
}

/// Does the surface that a pixel shows receive shadow of the light? Background does not.
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
