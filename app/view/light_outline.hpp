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

/// A light as a point sees it: what stands before it, flattened on it. Its rim is the square from −1 to 1, or the
/// circle of radius 1 in it, or a polygon in it.
struct LightOutline {
  enum class Rim { square, circle, polygon };
  Rim rim = Rim::square;
  std::vector<glm::dvec2> corners;  ///< of a polygon
  std::vector<std::vector<glm::dvec2>>
      blockers;          ///< convex: of each triangle what stands before the light; may reach beyond
  bool is_whole = true;  ///< no blocker was left out
};

/// Where a light is looked at from.
struct OutlineFrom {
  glm::dvec3 point;
  std::size_t triangle = 0;   ///< that carries the point, and hides nothing of the light from it
  std::size_t most = 20'000;  ///< blockers
};

/// `light`: one of the scene's, perhaps changed; what it has a body of is found by its name. Nothing of domes and of
/// lights in pieces, of which there is no plane; and of a point that a light does not shine to. Cut-outs count as if
/// they were solid.
std::optional<LightOutline> light_outline(const scenes::Scene& scene, const scenes::AreaLight& light,
                                          const OutlineFrom& from);

/// For a message: numbers are rounded to a ten-thousandth.
nlohmann::ordered_json outline_json(const LightOutline& outline, const std::string& light);

}  // namespace penumbra::app
