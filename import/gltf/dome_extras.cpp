// SPDX-License-Identifier: Apache-2.0
// A dome in a node's extras. The node's +Y is the dome's up axis. The shortest rotation from +Y to that axis also moves
// +X; the dome's rotation about the axis is the angle from there to the node's own +X.

#include "import/gltf/dome_extras.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_extras.hpp"

#include <tiny_gltf.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace penumbra::import {
namespace {

/// Returns the rotation in degrees about `up` of a dome whose picture has its +X side in the direction `right` (both
/// unit, at right angles).
double turn_of(const glm::dvec3& up, const glm::dvec3& right) {
  // Image of +X under the shortest rotation from +Y to `up`, as defined by scenes::Dome.
  glm::dvec3 start(1, 0, 0);
  if (up.y > -1 + 0x1p-40) start -= up.x / (1 + up.y) * glm::dvec3(up.x, 1 + up.y, up.z);
  return glm::degrees(std::atan2(glm::dot(right, glm::cross(up, start)), glm::dot(right, start)));
}

bool is_true(const tinygltf::Value& dome, const char* key, const std::string& place) {
  if (!dome.Has(key)) return false;
  if (!dome.Get(key).IsBool()) throw InputError("{}/{}: expected true or false", place, key);
  return dome.Get(key).Get<bool>();
}

}  // namespace

std::optional<scenes::AreaLight> dome_of(const tinygltf::Node& node, const PlacedNode& placed, scenes::Losses& losses) {
  if (!node.extras.IsObject() || !node.extras.Has("dome")) return std::nullopt;
  const std::string place = fmt::format("/nodes/{}/extras/dome", placed.number);
  const tinygltf::Value& value = node.extras.Get("dome");
  if (!value.IsObject() || !value.Has("radiance")) {
    losses.mention("has extras \"dome\" of another tool (no radiance), which are left out", node.name);
    return std::nullopt;
  }
  const auto radiance = list_of_extras(value, "radiance", 3, 0, place);
  const glm::dmat3 axes(placed.to_world);
  if (!(glm::determinant(axes) > 0)) throw InputError("{}: its transform mirrors it, or makes its axes vanish", place);
  scenes::Dome dome;
  dome.up = glm::normalize(axes[1]);
  dome.rotate = turn_of(dome.up, glm::normalize(axes[0] - glm::dot(axes[0], dome.up) * dome.up));
  dome.half = is_true(value, "half", place);
  dome.sampled = is_true(value, "sampled", place);
  if (value.Has("image")) {
    if (!value.Get("image").IsString()) throw InputError("{}/image: expected the name of a file", place);
    dome.image = value.Get("image").Get<std::string>();
  }
  scenes::AreaLight light;
  light.radiance = {radiance[0], radiance[1], radiance[2]};
  light.visible = is_true(value, "visible", place);
  light.shape = std::move(dome);
  return light;
}

}  // namespace penumbra::import
