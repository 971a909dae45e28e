// SPDX-License-Identifier: Apache-2.0
// Disk lights in files: reading and writing of JSON, checks for all formats, and the rim as a polygon of kRimSides
// corners for glTF, which has no disks.

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

LightShape read_disk(const nlohmann::json& value) {
  return Disk{read_vector(value["center"]), unit_direction(read_vector(value["normal"])),
              value["radius"].get<double>()};
}

void write_disk(const LightShape& shape, TextStream& text) {
  const auto& [center, normal, radius] = std::get<Disk>(shape);
  text.print(R"({{"center": )").array(center);
  text.print(R"(, "normal": )").array(normal);
  text.print(R"(, "radius": )").number(radius).print("}}");
}

void check_disk(const LightShape& shape, const std::string& where) {
  const auto& [center, normal, radius] = std::get<Disk>(shape);
  check_position(center, where, "center");
  check_position(normal, where, "normal");
  if (glm::length(normal) == 0) throw InputError("{}: the normal is zero; expected a direction", where);
  check_radius(radius, where);
}

std::vector<glm::dvec3> disk_outline(const LightShape& shape) {
  const auto& [center, normal, radius] = std::get<Disk>(shape);
  const glm::dvec3 aside = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 v = glm::normalize(glm::cross(normal, aside)), u = glm::cross(v, normal);
  return rim_points(center, radius * u, radius * v);
}

}  // namespace

const LightFormat kDiskFormat{.read = read_disk, .write = write_disk, .check = check_disk, .outline = disk_outline};

}  // namespace penumbra::scenes
