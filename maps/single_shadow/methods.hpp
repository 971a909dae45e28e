#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method; a description needs no device.
namespace penumbra::maps {

/// Wyman and Hansen 2003: cones and sheets at silhouettes, drawn in a second map. docs/penumbra-map.md.
std::unique_ptr<visibility::Method> make_penumbra_map(const render::Device& device,
                                                      const visibility::MethodOptions& options);
visibility::MethodDescription penumbra_map_description();

/// Chan and Durand 2003: strips beside silhouettes, drawn in a second map. docs/smoothies.md.
std::unique_ptr<visibility::Method> make_smoothies(const render::Device& device,
                                                   const visibility::MethodOptions& options);
visibility::MethodDescription smoothies_description();

/// Brabec and Seidel 2002: the nearest texel that shades, or does not, around a view sample. docs/brabec-seidel.md.
std::unique_ptr<visibility::Method> make_brabec_seidel(const render::Device& device,
                                                       const visibility::MethodOptions& options);
visibility::MethodDescription brabec_seidel_description();

/// Kirsch and Döllner 2003: how far inside the hard shadow a view sample is, from a map of distances.
/// docs/kirsch-doellner.md.
std::unique_ptr<visibility::Method> make_kirsch_doellner(const render::Device& device,
                                                         const visibility::MethodOptions& options);
visibility::MethodDescription kirsch_doellner_description();

/// Parker, Shirley and Smits 1998: objects with soft edges around a hard shadow. docs/parker.md.
std::unique_ptr<visibility::Method> make_parker(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription parker_description();

/// Arvo et al. 2004: the hard shadow's borders, flooded over the picture. docs/arvo.md.
std::unique_ptr<visibility::Method> make_arvo(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription arvo_description();

}  // namespace penumbra::maps
