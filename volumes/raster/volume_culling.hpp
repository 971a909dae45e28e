// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"

#include <cstdint>
#include <map>
#include <string>

/// Cheaper shadow volumes with the same shadows: at every view sample of the picture, their count is 0 exactly if the
/// count of all volumes is 0. A caster here is a set of triangles connected by edges.
namespace penumbra::volumes {

struct LeanVolumes {
  LightVolumes volumes;
  std::map<std::string, std::uint64_t> counters;  ///< numbers of omitted volumes, by names of `--stats`
};

/// D. B. Lloyd et al. 2004, CC shadow volumes: a caster has no volume if it hides nothing from any view sample, or
/// hides only samples that nearer casters hide. The other casters' volumes are restricted to the view samples behind
/// them, in up to four stretches.
LeanVolumes culled_and_clamped(const visibility::SceneFloats& scene, const ShadowCasters& casters,
                               const visibility::Light& light, const visibility::ViewSamples& samples);

/// M. Stich et al. 2007: nodes of the hierarchy, and finally triangles, that hide nothing from any view sample have no
/// volume, unless the rest of their caster has more silhouette edges than the whole caster.
LeanVolumes culled_by_hierarchy(const visibility::SceneFloats& scene, const ShadowCasters& casters,
                                const visibility::TriangleTree& tree, const visibility::Light& light,
                                const visibility::ViewSamples& samples);

/// S. Laine 2005, split-plane shadow volumes: for each caster, the plane through its middle and the light's centre l
/// divides the view samples. For those nearer to the eye than the plane, faces between the eye and them are counted;
/// for the others, faces beyond them.
LeanVolumes split_by_planes(const ShadowCasters& casters, const visibility::Light& light,
                            const visibility::ViewSamples& samples);

}  // namespace penumbra::volumes
