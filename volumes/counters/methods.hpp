// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::volumes {

/// Makes `depth-complexity`: an integer counter for each light sample: the number of triangles between p and it. Any
/// light (spheres and suns only on the processor's vector units), one- and two-sided, any pattern of light samples.
/// docs/depth-complexity.md.
///
/// variant=soup (default, an extension): signed multiplicities and a certified reference; any triangle soup, every bit
/// the truth of its pair. variant=laine (Laine et al. 2005): silhouettes count ±1 and one reference ray for each view
/// sample gives the constant; correct for closed meshes, wrong where an open one folds over. variant=forest (Forest et
/// al. 2008): only the silhouettes of the light's centre (packed_counters.hpp).
///
/// crop=off (soup and laine): every edge between p and the light is a candidate, silhouette or not; the masks are
/// equal, and it is slower (Lehtinen et al. 2006).
std::unique_ptr<visibility::Method> make_depth_complexity(const render::Machine& machine,
                                                          const visibility::MethodOptions& options);

/// Returns whether this light's shadows are computed on the processor although the method has a device.
bool depth_complexity_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                                 const visibility::Light& light);

/// Returns the description with the given options. Callable without a Vulkan device. Throws UsageError for unknown
/// options and options that exclude each other.
visibility::MethodDescription depth_complexity_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::volumes
