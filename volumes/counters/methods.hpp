#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method; a description needs no device.
namespace penumbra::volumes {

/// `depth-complexity`: an integer counter for each light sample: how many triangles are between p and it. Any
/// light (spheres and suns on the processor's vector units alone), one- and two-sided, any pattern of light samples.
/// docs/depth-complexity.md.
///
/// variant=soup (default; ours): signed multiplicities and a certified reference; any triangle soup, every bit the
/// truth of its pair. variant=laine (Laine et al. 2005): silhouettes count ±1 and one reference ray a view sample gives
/// the constant; right for closed meshes, wrong where an open one folds over. variant=forest (Forest et al. 2008): the
/// silhouettes of the light's centre alone, at most 16 light samples (packed_counters.hpp).
///
/// crop=off (soup and laine): every edge between p and the light is a candidate, silhouette or not; the masks are
/// equal, and it is slower (Lehtinen et al. 2006).
std::unique_ptr<visibility::Method> make_depth_complexity(const render::Machine& machine,
                                                          const visibility::MethodOptions& options);

/// Are this light's shadows computed on the processor, though the method is given a device?
bool depth_complexity_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                                 const visibility::Light& light);

/// What it is; needs no device.
/// Throws UsageError for options that are not its own or exclude each other.
visibility::MethodDescription depth_complexity_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::volumes
