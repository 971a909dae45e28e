// SPDX-License-Identifier: Apache-2.0
// Converts lights and cameras to and from the page's JSON.

#include "app/view/light_json.hpp"

#include "base/error.hpp"
#include "scenes/formats/json_reader.hpp"
#include "visibility/view_samples.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <variant>

namespace penumbra::app {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json array(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

template <typename Halves>
ordered_json halves(const Halves& shape) {
  return {{"center", array(shape.center)}, {"halfU", array(shape.half_u)}, {"halfV", array(shape.half_v)}};
}

struct ToJson {
  ordered_json& light;

  void operator()(const scenes::Rectangle& shape) const { light["rectangle"] = halves(shape); }
  void operator()(const scenes::Ellipse& shape) const { light["ellipse"] = halves(shape); }
  void operator()(const scenes::Disk& shape) const {
    light["disk"] = {{"center", array(shape.center)}, {"normal", array(shape.normal)}, {"radius", shape.radius}};
  }
  void operator()(const scenes::Polygon& shape) const {
    auto vertices = ordered_json::array();
    for (const glm::dvec3& vertex : shape.vertices) vertices.push_back(array(vertex));
    light["polygon"] = std::move(vertices);
  }
  void operator()(const scenes::Sphere& shape) const {
    light["sphere"] = {{"center", array(shape.center)}, {"radius", shape.radius}};
  }
  void operator()(const scenes::Sun& shape) const {
    light["sun"] = {{"direction", array(shape.direction)}, {"angle", shape.angle}};
  }
  template <typename Other>
  void operator()(const Other&) const {}
};

/// Reads a scene with only this light and camera, and a triangle that is not used.
scenes::Scene read_alone(json light, json camera) {
  const json triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  light["name"] = "light";
  const json scene = {{"format", "penumbra-scene/1"},
                      {"camera", std::move(camera)},
                      {"meshes", json::array({{{"name", "mesh"}, {"triangles", json::array({triangle})}}})},
                      {"lights", json::array({std::move(light)})}};
  return scenes::read_json_text(scene.dump(-1, ' ', false, json::error_handler_t::replace), "view", {});
}

bool has_shape(const json& light) {
  constexpr std::array kShapes = {"rectangle", "ellipse", "disk", "polygon", "sphere", "sun"};
  return std::ranges::any_of(kShapes, [&](const char* shape) { return light.contains(shape); });
}

const json& require_object(const json& value, const char* what) {
  if (!value.is_object()) throw InputError("the message has no {}", what);
  return value;
}

}  // namespace

ordered_json light_json(const scenes::AreaLight& light) {
  ordered_json made = {{"name", light.name}};
  std::visit(ToJson{made}, light.shape);
  const auto* const sun = std::get_if<scenes::Sun>(&light.shape);
  if (sun != nullptr)
    made["irradiance"] = array(light.radiance * (sun->angle > 0 ? irradiance_of_radiance(*sun) : 1));
  else
    made["radiance"] = array(light.radiance);
  made["twoSided"] = light.two_sided;
  return made;
}

ordered_json camera_json(const scenes::Camera& camera) {
  ordered_json made = {
      {"name", camera.name}, {"eye", array(camera.eye)}, {"target", array(camera.target)}, {"up", array(camera.up)}};
  if (camera.height)
    made["orthographicHeight"] = *camera.height;
  else
    made["verticalFov"] = camera.vertical_fov;
  return made;
}

scenes::AreaLight changed_light(const scenes::AreaLight& light, const json& change) {
  json own = require_object(change, "light");
  for (const auto& [key, value] : own.items()) {
    // Other keys of scene files name files and meshes.
    constexpr std::array kKnown = {"name",   "rectangle", "ellipse",    "disk",     "polygon",
                                   "sphere", "sun",       "irradiance", "radiance", "twoSided"};
    if (std::ranges::find(kKnown, key) == kKnown.end())
      throw InputError("light \"{}\": \"{}\" cannot be changed", light.name, key);
  }
  const bool has_own_shape = has_shape(light_json(light));
  const bool is_same_kind = has_own_shape == has_shape(own);
  if (!has_own_shape) own["sphere"] = {{"center", {0, 0, 0}}, {"radius", 1}};  // placeholder: files need a shape
  const scenes::AreaLight read = read_alone(std::move(own), {{"eye", {0, 0, 1}}, {"target", {0, 0, 0}}}).lights.front();
  if (!is_same_kind || (has_own_shape && read.shape.index() != light.shape.index()))
    throw InputError("light \"{}\": its kind cannot be changed", light.name);
  scenes::AreaLight made = light;
  if (has_own_shape) {
    std::optional<scenes::Cone> cone;
    if (const auto* before = std::get_if<scenes::Sphere>(&light.shape)) cone = before->cone;
    made.shape = read.shape;
    if (auto* after = std::get_if<scenes::Sphere>(&made.shape)) after->cone = cone;
  }
  made.radiance = read.radiance;
  made.two_sided = read.two_sided;
  return made;
}

scenes::Camera changed_camera(const scenes::Camera& camera, const json& change) {
  json own = require_object(change, "camera");
  own.erase("name");
  const scenes::Camera read =
      read_alone({{"sphere", {{"center", {0, 0, 0}}, {"radius", 1}}}}, std::move(own)).cameras.front();
  scenes::Camera made = camera;
  made.eye = read.eye;
  made.target = read.target;
  made.up = read.up;
  made.vertical_fov = read.vertical_fov;
  made.height = read.height;
  if (change.contains("shift")) made.shift = read.shift;
  visibility::make_camera(made, {}, 1, 1);  // throws for a camera that sees nothing
  return made;
}

}  // namespace penumbra::app
