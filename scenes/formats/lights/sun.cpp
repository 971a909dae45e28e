// SPDX-License-Identifier: Apache-2.0
// Suns in files: a direction and an apparent diameter in degrees. For glTF a sun is a directional lamp, whose
// intensity is the irradiance that the sun gives to a surface facing it.

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <variant>

namespace penumbra::scenes {
namespace {

LightShape read_sun(const nlohmann::json& value) {
  return Sun{unit_direction(read_vector(value["direction"])), value["angle"].get<double>()};
}

void write_sun(const LightShape& shape, TextStream& text) {
  const auto& [direction, angle] = std::get<Sun>(shape);
  text.print(R"({{"direction": )").array(direction);
  text.print(R"(, "angle": )").number(angle).print("}}");
}

void check_sun(const LightShape& shape, const std::string& where) {
  const auto& [direction, angle] = std::get<Sun>(shape);
  check_position(direction, where, "direction");
  if (glm::length(direction) == 0)
    throw InputError("{}: the direction is zero; expected the direction in which light travels", where);
  if (!(angle >= 0 && angle < 180)) {
    throw InputError("{}: the angle is {} degrees; expected the sun's apparent diameter, from 0 to less than 180",
                     where, angle);
  }
}

GltfLamp sun_lamp(const LightShape& shape) {
  const auto& sun = std::get<Sun>(shape);
  return {.type = "directional",
          .direction = sun.direction,
          .intensity = sun.angle > 0 ? irradiance_of_radiance(sun) : 1,
          .size = {"angle", sun.angle}};
}

}  // namespace

const LightFormat kSunFormat{.read = read_sun, .write = write_sun, .check = check_sun, .lamp = sun_lamp};

}  // namespace penumbra::scenes
