#pragma once

#include "visibility/light_samples.hpp"
#include "volumes/radial_coverage.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

/// What triangles hide of a light, each by itself: no edge graph, no multiplicity, no reference point. The judge of the
/// sums over silhouettes.
namespace penumbra::volumes {

struct ProjectedLayers {
  std::vector<std::vector<glm::dvec2>> polygons;  ///< convex, counter-clockwise, in frame coordinates
  bool touch_light = false;  ///< some triangle crosses the light's plane within the light: there it ends at no edge
};
/// Each triangle, as p sees it, clipped to the light (a disk: to the square around it). Those of no area are left out.
/// p must be off the light's plane (asserted).
ProjectedLayers projected_layers(const visibility::Light& light, const glm::vec3& p,
                                 std::span<const std::array<glm::vec3, 3>> triangles);

/// Σ of the polygons' areas within the light, of |L|: the mean number of layers.
double sum_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers);

/// Σ over pairs of what both hide, of |L| (a disk's: on the square around it, at most): what the layers' sum is beyond
/// their union is at most this, and 0 if and only if this is. Looks no further once it is beyond `stop`.
double overlap_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers, double stop);

}  // namespace penumbra::volumes
