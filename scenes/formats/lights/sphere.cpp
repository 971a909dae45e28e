// SPDX-License-Identifier: Apache-2.0
// Sphere lights in files, with or without a cone. For glTF a sphere is a point or spot lamp with the intensity of a
// disk of its radius, radiance · π r².

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <numbers>
#include <variant>

namespace penumbra::scenes {
namespace {

LightShape read_sphere(const nlohmann::json& value) {
  Sphere sphere{read_vector(value["center"]), value["radius"].get<double>(), {}};
  if (value.contains("cone")) {
    const nlohmann::json& cone = value["cone"];
    sphere.cone = Cone{unit_direction(read_vector(cone["direction"])), cone["inner"].get<double>(),
                       cone["outer"].get<double>(), cone.value("smooth", false)};
  }
  return sphere;
}

void write_sphere(const LightShape& shape, TextStream& text) {
  const auto& [center, radius, cone] = std::get<Sphere>(shape);
  text.print(R"({{"center": )").array(center);
  text.print(R"(, "radius": )").number(radius);
  if (cone) {
    text.print(R"(, "cone": {{"direction": )").array(cone->direction);
    text.print(R"(, "inner": )").number(cone->inner);
    text.print(R"(, "outer": )").number(cone->outer);
    text.print("{}}}", cone->smooth ? R"(, "smooth": true)" : "");
  }
  text.print("}}");
}

void check_sphere(const LightShape& shape, const std::string& where) {
  const auto& [center, radius, cone] = std::get<Sphere>(shape);
  check_position(center, where, "center");
  check_radius(radius, where);
  if (!cone) return;
  const auto& [direction, inner, outer, smooth] = *cone;
  check_position(direction, where, "the cone's direction");
  if (glm::length(direction) == 0)
    throw InputError("{}: the cone's direction is zero; expected the direction in which it shines", where);
  if (!(inner >= 0 && inner <= outer && outer > 0 && outer <= 90)) {
    throw InputError("{}: the cone reaches from {} to {} degrees; expected 0 <= inner <= outer <= 90, outer above 0",
                     where, inner, outer);
  }
}

/// Returns a point or spot lamp with the intensity that a disk of the sphere's radius has along its axis.
GltfLamp sphere_lamp(const LightShape& shape) {
  const auto& [center, radius, cone] = std::get<Sphere>(shape);
  return {.type = cone ? "spot" : "point",
          .direction = cone ? cone->direction : glm::dvec3(0, 0, -1),
          .position = center,
          .intensity = std::numbers::pi * radius * radius,
          .size = {"radius", radius},
          .cone = cone};
}

}  // namespace

const LightFormat kSphereFormat{.read = read_sphere, .write = write_sphere, .check = check_sphere, .lamp = sphere_lamp};

}  // namespace penumbra::scenes
