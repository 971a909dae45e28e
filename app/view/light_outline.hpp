// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// A light as seen from a point, with the blockers in front of it projected onto it. Its rim is the square from −1 to
/// 1, or the circle of radius 1 in that square, or a polygon in it.
struct LightOutline {
  enum class Rim { square, circle, polygon };
  Rim rim = Rim::square;
  std::vector<glm::dvec2> corners;  ///< corners of a polygonal light
  std::vector<std::vector<glm::dvec2>>
      blockers;          ///< convex: the part of each triangle in front of the light; may reach beyond its rim
  bool is_whole = true;  ///< false: blockers were left out
};

/// Point from which a light is seen.
struct OutlineFrom {
  glm::dvec3 point;
  std::size_t triangle = 0;   ///< triangle that carries the point, and hides nothing of the light from it
  std::size_t most = 20'000;  ///< largest number of blockers
};

/// Computes the outline of `light`: one of the scene's, perhaps changed; its body is found by its name. Returns nullopt
/// for domes and lights in pieces, which have no plane, and for a point that does not receive the light. Cut-outs count
/// as solid.
std::optional<LightOutline> light_outline(const scenes::Scene& scene, const scenes::AreaLight& light,
                                          const OutlineFrom& from);

/// Writes the outline for a message: numbers are rounded to a ten-thousandth.
nlohmann::ordered_json outline_json(const LightOutline& outline, const std::string& light);

}  // namespace penumbra::app
