// SPDX-License-Identifier: Apache-2.0
// An area lamp in a node's extras, as Blender's add-on and `convert` write it: the node's axes and the lamp's sizes
// make a rectangle or an ellipse, which is a disk if it is round up to rounding.

#include "import/gltf/area_lamp.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_extras.hpp"

#include <tiny_gltf.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace penumbra::import {
namespace {

/// Returns whether the shape is a circle, up to the rounding of a transform in single precision.
bool is_round(const glm::dvec3& u, const glm::dvec3& v) {
  const double rounding = 8 * static_cast<double>(std::numeric_limits<float>::epsilon()) * glm::dot(u, u);
  return std::abs(glm::dot(u, v)) <= rounding && std::abs(glm::dot(u, u) - glm::dot(v, v)) <= rounding;
}

}  // namespace

std::optional<scenes::AreaLight> area_lamp_of(const tinygltf::Node& node, const PlacedNode& placed,
                                              scenes::Losses& losses) {
  if (!node.extras.IsObject() || !node.extras.Has("areaLamp")) return std::nullopt;
  const std::string place = fmt::format("/nodes/{}/extras/areaLamp", placed.number);
  const tinygltf::Value& lamp = node.extras.Get("areaLamp");
  if (!lamp.IsObject() || !lamp.Has("shape") || !lamp.Has("size") || !lamp.Has("radiance")) {
    losses.mention("has extras \"areaLamp\" of another tool (no shape, size and radiance), which are left out",
                   node.name);
    return std::nullopt;
  }
  const auto size = list_of_extras(lamp, "size", 2, 0, place);
  const auto radiance = list_of_extras(lamp, "radiance", 3, 0, place);
  const glm::dvec3 center(placed.to_world[3]);
  const glm::dvec3 u = size[0] / 2 * glm::dvec3(placed.to_world[0]);
  glm::dvec3 v = size[1] / 2 * glm::dvec3(placed.to_world[1]);
  const glm::dvec3 along = -glm::dvec3(placed.to_world[2]);
  if (!(glm::length(glm::cross(u, v)) > 0)) throw InputError("{}: it has no area in the world", place);
  if (glm::dot(glm::cross(u, v), along) < 0) v = -v;  // the light must shine along u × v
  scenes::AreaLight light;
  light.radiance = {radiance[0], radiance[1], radiance[2]};
  const tinygltf::Value& shape = lamp.Get("shape");
  const std::string kind = shape.IsString() ? shape.Get<std::string>() : "";
  if (kind == "rectangle") {
    light.shape = scenes::Rectangle{center, u, v};
  } else if (kind == "ellipse") {
    if (is_round(u, v))
      light.shape = scenes::Disk{center, glm::normalize(glm::cross(u, v)), glm::length(u)};
    else
      light.shape = scenes::Ellipse{center, u, v};
  } else {
    throw InputError("{}/shape: expected \"rectangle\" or \"ellipse\"", place);
  }
  return light;
}

}  // namespace penumbra::import
