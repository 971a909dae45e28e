// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "volumes/wedges/radial_coverage.hpp"
#include "volumes/wedges/texture_weights.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

/// Areas of a light that triangles hide, each triangle on its own: no edge graph, no multiplicity, no reference point.
/// Reference values for the sums over silhouettes.
namespace penumbra::volumes {

/// Returns each triangle, projected from p and clipped to the light (a disk: to the square around it): convex polygons
/// in frame coordinates, counter-clockwise. Polygons without area are left out. p must be off the light's plane
/// (asserted).
std::vector<std::vector<glm::dvec2>> projected_layers(const visibility::Light& light, const glm::vec3& p,
                                                      std::span<const std::array<glm::vec3, 3>> triangles);

/// Returns whether the triangle meets the light itself (a disk: the square around it; a sphere: the ball). At the
/// light, the triangle's shadow ends at none of its edges. Exact for triangles that do not meet a planar light's plane;
/// for the others true slightly too often.
bool touches_light(const visibility::Light& light, const std::array<glm::vec3, 3>& triangle);

/// Returns Σ of the polygons' areas within the light, as a fraction of |L|: the mean number of layers. With `texture`,
/// Σ of the polygons' weights.
double sum_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers,
                     const TextureWeights* texture = nullptr);

/// Returns Σ over pairs of layers of the area hidden by both, as a fraction of |L| (for a disk: on the square around
/// it, an upper bound). The sum of layers exceeds their union by at most this overlap, and by 0 if and only if the
/// overlap is 0. Stops summing once the overlap is beyond `stop`.
double overlap_of_layers(const LightOutline& outline, std::span<const std::vector<glm::dvec2>> layers, double stop,
                         const TextureWeights* texture = nullptr);

}  // namespace penumbra::volumes
