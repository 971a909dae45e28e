// SPDX-License-Identifier: Apache-2.0
// Domes in files: the up direction, a rotation about it, half or all of the sky, and the name of a picture. glTF has no
// sky; import/gltf/dome_extras.hpp reads one from extras.

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <variant>

namespace penumbra::scenes {
namespace {

LightShape read_dome(const nlohmann::json& value) {
  Dome dome;
  if (value.contains("up")) dome.up = unit_direction(read_vector(value["up"]));
  dome.rotate = value.value("rotate", 0.0);
  dome.half = value.value("half", false);
  dome.sampled = value.value("sampled", false);
  dome.image = value.value("image", std::string());
  return dome;
}

void write_dome(const LightShape& shape, TextStream& text) {
  const auto& [up, rotate, half, sampled, image] = std::get<Dome>(shape);
  text.print("{{");
  if (!image.empty())
    text.print(R"("image": {}, )",
               nlohmann::json(image).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  text.print(R"("rotate": )").number(rotate);
  text.print(R"(, "up": )").array(up);
  text.print(R"(, "half": {})", half);
  text.print("{}}}", sampled ? R"(, "sampled": true)" : "");
}

void check_dome(const LightShape& shape, const std::string& where) {
  const auto& dome = std::get<Dome>(shape);
  check_position(dome.up, where, "up");
  if (glm::length(dome.up) == 0) throw InputError("{}: up is zero; expected a direction such as [0, 1, 0]", where);
  if (!std::isfinite(dome.rotate)) throw InputError("{}: rotate is {}; expected degrees", where, dome.rotate);
}

}  // namespace

const LightFormat kDomeFormat{.read = read_dome, .write = write_dome, .check = check_dome};

}  // namespace penumbra::scenes
