// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `penumbra-map` (Wyman and Hansen 2003): cones and sheets at silhouettes, drawn in a second map.
/// docs/penumbra-map.md.
std::unique_ptr<visibility::Method> make_penumbra_map(const render::Device& device,
                                                      const visibility::MethodOptions& options);
visibility::MethodDescription penumbra_map_description();

/// Makes `smoothies` (Chan and Durand 2003): strips beside silhouettes, drawn in a second map. docs/smoothies.md.
std::unique_ptr<visibility::Method> make_smoothies(const render::Device& device,
                                                   const visibility::MethodOptions& options);
visibility::MethodDescription smoothies_description();

/// Makes `brabec-seidel` (Brabec and Seidel 2002): the nearest texel around a view sample that shades, or does not.
/// docs/brabec-seidel.md.
std::unique_ptr<visibility::Method> make_brabec_seidel(const render::Device& device,
                                                       const visibility::MethodOptions& options);
visibility::MethodDescription brabec_seidel_description();

/// Makes `kirsch-doellner` (Kirsch and Döllner 2003): distance of a view sample from the border of the hard shadow,
/// from a map of distances. docs/kirsch-doellner.md.
std::unique_ptr<visibility::Method> make_kirsch_doellner(const render::Device& device,
                                                         const visibility::MethodOptions& options);
visibility::MethodDescription kirsch_doellner_description();

/// Makes `parker` (Parker, Shirley and Smits 1998): objects with soft edges around a hard shadow. docs/parker.md.
std::unique_ptr<visibility::Method> make_parker(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription parker_description();

/// Makes `arvo` (Arvo et al. 2004): the hard shadow's borders, flooded over the picture. docs/arvo.md.
std::unique_ptr<visibility::Method> make_arvo(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription arvo_description();

}  // namespace penumbra::maps
