#pragma once

#include "visibility/light_samples.hpp"
#include "volumes/wedges/radial_coverage.hpp"
#include "volumes/wedges/texture_weights.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

/// What triangles hide of a light, each by itself: no edge graph, no multiplicity, no reference point. The judge of the
/// sums over silhouettes.
namespace penumbra::volumes {

/// Each triangle, as p sees it, clipped to the light (a disk: to the square around it): convex polygons in frame
/// coordinates, counter-clockwise. Those of no area are left out. p must be off the light's plane (asserted).
std::vector<std::vector<glm::dvec2>> projected_layers(const visibility::Light& light, const glm::vec3& p,
                                                      std::span<const std::array<glm::vec3, 3>> triangles);

/// Does the triangle meet the light itself (a disk: the square around it; a sphere: the ball)? There its shadow ends at
/// none of its edges. Exact for those that do not meet a planar light's plane; else a hair too often.
bool touches_light(const visibility::Light& light, const std::array<glm::vec3, 3>& triangle);

/// Σ of the polygons' areas within the light, of |L|: the mean number of layers. With a texture, of their weights.
double sum_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers,
                     const TextureWeights* texture = nullptr);

/// Σ over pairs of what both hide, of |L| (a disk's: on the square around it, at most): what the layers' sum is beyond
/// their union is at most this, and 0 if and only if this is. Looks no further once it is beyond `stop`.
double overlap_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers, double stop,
                         const TextureWeights* texture = nullptr);

}  // namespace penumbra::volumes
