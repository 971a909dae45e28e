#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"

#include <cstdint>
#include <map>
#include <string>

/// Shadow volumes that cost less and hide the same: where a count of all is 0, so is a count of these at every view
/// sample of the picture, and where it is not, neither is this. What is a caster here is what hangs together by edges.
namespace penumbra::volumes {

struct LeanVolumes {
  LightVolumes volumes;
  std::map<std::string, std::uint64_t> counters;  ///< what was left out, by names of `--stats`
};

/// D. B. Lloyd et al. 2004, CC shadow volumes: casters that hide nothing from any view sample, or only what nearer ones
/// hide, have no volume; what is left of the others is where their view samples are, in up to four stretches.
LeanVolumes culled_and_clamped(const visibility::SceneFloats& scene, const ShadowCasters& casters,
                               const visibility::Light& light, const visibility::ViewSamples& samples);

/// M. Stich et al. 2007: the hierarchy's nodes, and at last triangles, that hide nothing from any view sample have no
/// volume, unless what is left of their caster has more silhouette edges than all of it.
LeanVolumes culled_by_hierarchy(const visibility::SceneFloats& scene, const ShadowCasters& casters,
                                const visibility::TriangleTree& tree, const visibility::Light& light,
                                const visibility::ViewSamples& samples);

/// S. Laine 2005, split-plane shadow volumes: of each caster, view samples nearer to the eye than the plane through its
/// middle and l count before them, and the others beyond.
LeanVolumes split_by_planes(const ShadowCasters& casters, const visibility::Light& light,
                            const visibility::ViewSamples& samples);

}  // namespace penumbra::volumes
