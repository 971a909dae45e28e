// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `accumulate` (Heckbert and Herf 1997): one shadow map for each light sample. docs/accumulate.md.
std::unique_ptr<visibility::Method> make_accumulate(const render::Device& device,
                                                    const visibility::MethodOptions& options);
visibility::MethodDescription accumulate_description();

/// Makes `adaptive-light` (Schwärzler): shadow maps from points of the light that are added where two maps differ.
/// docs/adaptive-light.md.
std::unique_ptr<visibility::Method> make_adaptive_light(const render::Device& device,
                                                        const visibility::MethodOptions& options);
visibility::MethodDescription adaptive_light_description();

/// Makes `deep-penumbra` (St-Amour, Paquette and Poulin 2005): V as a function of depth in every texel.
/// docs/deep-penumbra.md.
std::unique_ptr<visibility::Method> make_deep_penumbra(const render::Device& device,
                                                       const visibility::MethodOptions& options);
visibility::MethodDescription deep_penumbra_description();

/// Makes `layered-attenuation` (Agrawala et al. 2000): number of light samples that see each surface of a layered depth
/// image. docs/layered-attenuation.md.
std::unique_ptr<visibility::Method> make_layered_attenuation(const render::Device& device,
                                                             const visibility::MethodOptions& options);
visibility::MethodDescription layered_attenuation_description();

}  // namespace penumbra::maps
