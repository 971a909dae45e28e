// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <variant>

/// Common parts of rectangles and ellipses: a centre and two half sides, or conjugate half diameters. Internal to
/// scenes/.
namespace penumbra::scenes {

template <typename Halved>
LightShape read_halves(const nlohmann::json& value) {
  return Halved{read_vector(value["center"]), read_vector(value["halfU"]), read_vector(value["halfV"])};
}

template <typename Halved>
void write_halves(const LightShape& shape, TextStream& text) {
  const auto& [center, half_u, half_v] = std::get<Halved>(shape);
  text.print(R"({{"center": )").array(center);
  text.print(R"(, "halfU": )").array(half_u);
  text.print(R"(, "halfV": )").array(half_v).print("}}");
}

template <typename Halved>
void check_halves(const LightShape& shape, const std::string& where) {
  const auto& [center, half_u, half_v] = std::get<Halved>(shape);
  check_position(center, where, "center");
  check_position(half_u, where, "halfU");
  check_position(half_v, where, "halfV");
  const double u = glm::length(half_u), v = glm::length(half_v);
  // The cross product of parallel vectors is off by a few roundings of its terms, which are at most u · v.
  if (!(glm::length(glm::cross(half_u, half_v)) > 8 * std::numeric_limits<double>::epsilon() * u * v)) {
    throw InputError("{}: the light has no area: halfU {} and halfV {} must be neither zero nor parallel", where,
                     show_vector(half_u), show_vector(half_v));
  }
}

/// Returns a hint with `meaning` if the halves are not at right angles, else an empty text.
template <typename Halved>
std::string hint_of_halves(const LightShape& shape, const char* meaning) {
  const auto& halved = std::get<Halved>(shape);
  const double cosine = glm::dot(glm::normalize(halved.half_u), glm::normalize(halved.half_v));
  // The threshold avoids a hint for right angles that are inexact only because of rounded decimals.
  return std::abs(cosine) > 1e-3 ? fmt::format("halfU and halfV are not at right angles; {}", meaning) : "";
}

}  // namespace penumbra::scenes
