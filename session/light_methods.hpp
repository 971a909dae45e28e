// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::session {

/// Method and options given on the command line.
struct MethodWish {
  std::string method;  ///< empty: the best for each light
  visibility::MethodOptions options;
  bool samples = false;  ///< light samples were requested
};

/// Method of one light.
struct LightMethod {
  visibility::MethodDescription description;  ///< with its options
  visibility::MethodOptions options;
  std::string note;  ///< reason why light samples are used without a request; else empty
};

/// Scene for which methods are chosen.
struct LightScene {
  const visibility::SceneFloats& floats;
  const std::vector<scenes::AreaLight>& sources;  ///< those of Light::index
  std::uint64_t triangles = 0;                    ///< of the whole scene, of which `floats` may be a part
};

/// Chooses the methods, exact by default, light by light. Without a request for light samples: the first method of the
/// table that computes a light's exact area (`exact_area`) and supports its distance and size relative to the scene
/// (`span`), with the options needed for this; if a method was named, only that one, if possible. If there is none, or
/// light samples were requested, by the wish or by the light's source (Dome::sampled): the default method for light
/// samples. An option applies to the chosen methods that have it. Throws UsageError for an option that none has, and
/// the exceptions of describe_method.
std::vector<LightMethod> choose_light_methods(const std::vector<visibility::Light>& lights, const LightScene& scene,
                                              const MethodWish& wish);

/// Returns whether the light's own description requests light samples (scenes::Dome::sampled).
bool is_sampled(const scenes::AreaLight& source);

/// Returns whether the methods of all domes among the lights will certainly compute the visibility of each light
/// sample, and no areas.
bool counts_dome_samples(const MethodWish& wish, const std::vector<scenes::AreaLight>& lights);

/// Groups the lights (indices) by method and options; groups are in the order of their first lights.
std::vector<std::vector<std::size_t>> same_methods(const std::vector<LightMethod>& chosen);

}  // namespace penumbra::session
