// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `shadow-map` (Williams 1978): the hard shadow from the light's centre. docs/shadow-map.md.
std::unique_ptr<visibility::Method> make_shadow_map(const render::Device& device,
                                                    const visibility::MethodOptions& options);
visibility::MethodDescription shadow_map_description();

/// Makes `silhouette-map` (Sen, Cammarano, Hanrahan 2003): the hard shadow from the light's centre, with the outlines
/// that pass between texels. docs/silhouette-map.md.
std::unique_ptr<visibility::Method> make_silhouette_map(const render::Device& device,
                                                        const visibility::MethodOptions& options);
visibility::MethodDescription silhouette_map_description();

/// Makes `forward-map` (Zhang 1998): the light's texels, splatted onto the surfaces that they light.
/// docs/forward-map.md.
std::unique_ptr<visibility::Method> make_forward_map(const render::Device& device,
                                                     const visibility::MethodOptions& options);
visibility::MethodDescription forward_map_description();

/// Makes `pcf` (Reeves, Salesin, Cook 1987): the fraction of a fixed window's texels that do not shade the receiver, in
/// one map from the light's centre. docs/pcf.md.
std::unique_ptr<visibility::Method> make_pcf(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription pcf_description();

/// Makes `pcss` (Fernando 2005): percentage-closer soft shadows on one map from the light's centre. docs/pcss.md.
std::unique_ptr<visibility::Method> make_pcss(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription pcss_description();

/// Makes `vssm`, variance soft shadow mapping and related methods (Lauritzen 2007, Annen et al. 2008, Yang et al.
/// 2010): pcss with moments of the depths of its two windows in place of taps. docs/vssm.md.
std::unique_ptr<visibility::Method> make_vssm(const render::Device& device, const visibility::MethodOptions& options);
visibility::MethodDescription vssm_description();

/// Makes `convolution` (Soler and Sillion 1998): one picture of all blockers, convolved with the light.
/// docs/convolution.md.
std::unique_ptr<visibility::Method> make_convolution(const render::Device& device,
                                                     const visibility::MethodOptions& options);
visibility::MethodDescription convolution_description();

/// Makes `occlusion-textures` (Eisemann and Décoret 2006): casters in slices parallel to the light, each a picture
/// filtered by the light's box. docs/occlusion-textures.md.
std::unique_ptr<visibility::Method> make_occlusion_textures(const render::Device& device,
                                                            const visibility::MethodOptions& options);
visibility::MethodDescription occlusion_textures_description();

}  // namespace penumbra::maps
