// SPDX-License-Identifier: Apache-2.0
#pragma once

// The refusals that a test of methods may ignore: each is recognised by its cause, and any other is rethrown.

#include "base/error.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <glm/vec3.hpp>

#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace penumbra::tests {

inline bool says(const InputError& error, std::string_view words) {
  return std::string_view(error.what()).find(words) != std::string_view::npos;
}
/// Returns whether this is visibility::check_size's refusal of a light that float32 cannot represent together with the
/// scene.
inline bool refuses_size(const InputError& error) {
  return says(error, "handles lights between 2^-28 and 2^28 of the scene's size");
}

/// Returns whether visibility::check_size accepts a planar light.
inline bool spans(const visibility::SceneFloats& floats, const visibility::Light& light) {
  try {
    visibility::check_size(light, visibility::make_device_light(light, visibility::device_scale(floats)), "this test");
    return true;
  } catch (const InputError& error) {
    if (!refuses_size(error)) throw;
    return false;
  }
}

/// Returns the result of `answer`, for a method that applies check_size to the frame of make_device_light; nullopt if
/// the method refuses the light, which it must do exactly if `spans` is false. Rethrows other refusals, and throws
/// std::logic_error if a light that must be refused is not.
template <typename Answer>
auto unless_too_far_apart(const visibility::SceneFloats& floats, const visibility::Light& light, Answer&& answer)
    -> std::optional<decltype(answer())> {
  const bool spanned = spans(floats, light);
  try {
    auto result = std::forward<Answer>(answer)();
    if (!spanned) throw std::logic_error("a light is not refused that float32 does not span together with the scene");
    return result;
  } catch (const InputError& error) {
    if (spanned || !refuses_size(error)) throw;
    return std::nullopt;
  }
}

/// Returns the scene's only light; nullopt if it is so small that it has no area in float32 at its distance from the
/// origin.
inline std::optional<visibility::Light> light_with_area(const scenes::Scene& scene, const glm::dvec3& origin,
                                                        const visibility::SampleRequest& request) {
  try {
    return visibility::make_light(scene, 0, origin, request);
  } catch (const InputError& error) {
    if (!says(error, "its area is zero")) throw;
    return std::nullopt;
  }
}

}  // namespace penumbra::tests
