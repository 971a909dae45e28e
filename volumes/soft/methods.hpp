// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::volumes {

/// Makes `soft-volume` (Assarsson and Akenine-Möller 2003): soft shadow volumes. docs/soft-volume.md.
std::unique_ptr<visibility::Method> make_soft_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options);
visibility::MethodDescription soft_volume_description();

/// Makes `soft-volume-blend` (Forest, Barthe and Paulin 2006): soft shadow volumes that separate the covers of
/// different occluders, by boxes, in each quarter of the light. docs/soft-volume-blend.md.
std::unique_ptr<visibility::Method> make_soft_volume_blend(const render::Device& device,
                                                           const visibility::MethodOptions& options);
visibility::MethodDescription soft_volume_blend_description();

/// Makes `soft-irregular` (Johnson et al. 2009): an irregular shadow map of the light's centre for the umbra, and the
/// penumbra wedges of the centre's silhouettes drawn over view samples in a grid of the light's frustum, with signed
/// areas by arc cosines. Planar lights; on the processor. With umbra=layers, V is that of `soft-volume`; with
/// umbra=map, as published, V is wrong where one occluder is behind another. docs/soft-irregular.md.
std::unique_ptr<visibility::Method> make_soft_irregular(const visibility::MethodOptions& options);

/// Makes `wedge-ramp` (Akenine-Möller and Assarsson 2002): a linear ramp across each penumbra wedge.
/// docs/wedge-ramp.md.
std::unique_ptr<visibility::Method> make_wedge_ramp(const render::Device& device,
                                                    const visibility::MethodOptions& options);
visibility::MethodDescription wedge_ramp_description();

/// Makes `plateaus` (Haines 2001): the hard shadow of the light's centre, and outer penumbrae around its silhouettes.
/// docs/plateaus.md.
std::unique_ptr<visibility::Method> make_plateaus(const render::Device& device,
                                                  const visibility::MethodOptions& options);
visibility::MethodDescription plateaus_description();

/// Makes `hard-volume` (Crow 1977): the hard shadow of the light's centre by shadow volumes. docs/hard-volume.md.
std::unique_ptr<visibility::Method> make_hard_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options);
visibility::MethodDescription hard_volume_description();

}  // namespace penumbra::volumes
