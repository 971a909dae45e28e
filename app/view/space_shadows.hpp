// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/wedges/built_wedges.hpp"
#include "visibility/light_samples.hpp"
#include "volumes/wedges/wedge_casters.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// Largest number of wedges whose bodies are sent at once, and of silhouette edges whose shadow volume is sent.
inline constexpr std::size_t kMostShownBodies = 2'000, kMostShownSides = 50'000;
/// Largest number of wedges containing a point that are listed by their numbers.
inline constexpr std::size_t kMostNamedWedges = 1'000;

/// Request of the 3D view: which of a light's shadows to show.
struct SpaceShadows {
  session::WedgeRequest wedges = {};        ///< light, construction and from
  glm::dvec2 place{0};                      ///< point of the light from which silhouettes are seen: light_point()
  std::optional<double> floor = {};         ///< height of the plane that bodies are cut by; nullopt: the lowest point
  std::optional<std::uint32_t> wedge = {};  ///< only this wedge's body; nullopt: all
  std::optional<glm::dvec3> point = {};     ///< point whose wedges are named, relative to the origin
};

/// Returns a point of the light: center + s u + t v, s and t in [−1, 1], u and v half the light's extents (of a sphere
/// along x and z; of a polygon across its bounding rectangle), moved toward the light's centre if it is not on the
/// light.
glm::dvec3 light_point(const visibility::Light& light, const glm::dvec2& place);

/// Returns the side of the shadow volume that belongs to an edge a b, clipped to the box: the area between the rays
/// a + t (a − l) and b + t (b − l), t ≥ 0. It is a convex polygon, and empty if the edge's ends and l are on a line.
std::vector<glm::dvec3> volume_side(const std::array<glm::dvec3, 2>& edge, const glm::dvec3& l,
                                    const volumes::Box& box);

/// Returns the line, within the box, in which volume_side() meets the plane y = `height`; nullopt if it does not meet
/// the plane, or lies in it.
std::optional<std::array<glm::dvec3, 2>> side_at(const std::array<glm::dvec3, 2>& edge, const glm::dvec3& l,
                                                 const volumes::Box& box, double height);

/// Returns the message of a light's silhouettes, shadow volume and wedges (docs/view.md), relative to `origin`. The
/// light must have wedges (require_wedges). Throws UsageError for an invalid request.
std::string shadows_message(const volumes::Casters& casters, const visibility::Light& light, const glm::dvec3& origin,
                            const SpaceShadows& request);

}  // namespace penumbra::app
