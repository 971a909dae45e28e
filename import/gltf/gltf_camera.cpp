// SPDX-License-Identifier: Apache-2.0
// Converts a glTF camera, perspective or orthographic, to the program's own. Aperture, focus and shift of its lens come
// from the extras, since glTF 2.0 has none of them.

#include "import/gltf/gltf_camera.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace penumbra::import {

namespace {

/// Returns "shift" of the extras (Camera::shift; glTF has no shifted lenses); nullopt if it is not a pair of numbers,
/// and so belongs to another tool.
std::optional<glm::dvec2> shift_of(const tinygltf::Value& pair) {
  if (!pair.IsArray() || pair.ArrayLen() != 2 || !pair.Get(0).IsNumber() || !pair.Get(1).IsNumber())
    return std::nullopt;
  return glm::dvec2(pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble());
}

/// Reads the extras "aperture" and "focusDistance" (ThinLens), since glTF has no lenses; returns nullopt unless both
/// are lengths above 0: other values belong to another tool.
std::optional<scenes::ThinLens> lens_of(const tinygltf::Value& extras) {
  const auto length = [&](const char* key) {
    const tinygltf::Value& value = extras.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : 0.0;
  };
  const scenes::ThinLens lens{length("aperture"), length("focusDistance")};
  const auto is_length = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_length(lens.radius) || !is_length(lens.focus_distance)) return std::nullopt;
  return lens;
}

}  // namespace

scenes::Camera camera_of(const tinygltf::Model& model, const tinygltf::Node& node, const PlacedNode& placed,
                         scenes::Losses& losses) {
  if (static_cast<std::size_t>(node.camera) >= model.cameras.size()) {
    throw InputError("/nodes/{}/camera: camera {} does not exist; there are {}", placed.number, node.camera,
                     model.cameras.size());
  }
  const tinygltf::Camera& source = model.cameras[static_cast<std::size_t>(node.camera)];
  const bool perspective = source.type == "perspective";
  const double angle = source.perspective.yfov, height = 2 * source.orthographic.ymag;
  if (perspective && !(angle > 0 && angle < glm::radians(180.0))) {
    throw InputError("/cameras/{}/perspective/yfov: {}; expected more than 0 and less than pi", node.camera, angle);
  }
  if (!perspective && !(height > 0 && std::isfinite(height))) {
    throw InputError("/cameras/{}/orthographic/ymag: {}; expected a length above 0", node.camera, height / 2);
  }
  // A camera looks along −Z of its node, with +Y up (glTF 2.0, 3.10).
  const glm::dvec3 forward(placed.to_world * glm::dvec4(0, 0, -1, 0)), up(placed.to_world * glm::dvec4(0, 1, 0, 0));
  if (!(glm::length(glm::cross(forward, up)) > 0)) {
    throw InputError("/nodes/{}: its transform squashes the camera flat", placed.number);
  }
  scenes::Camera camera;
  camera.eye = glm::dvec3(placed.to_world[3]);
  camera.target = camera.eye + glm::normalize(forward);
  camera.up = glm::normalize(up);
  if (perspective)
    camera.vertical_fov = glm::degrees(angle);
  else
    camera.height = height;
  const double aspect = perspective ? source.perspective.aspectRatio : 2 * source.orthographic.xmag / height;
  if (aspect > 0 && std::isfinite(aspect)) camera.aspect = aspect;
  if (source.extras.IsObject() && source.extras.Has("shift")) {
    if (const auto shift = shift_of(source.extras.Get("shift")))
      camera.shift = *shift;
    else
      losses.mention("has extras \"shift\" of another tool (not two numbers), which are left out", node.name);
  }
  if (source.extras.IsObject() && source.extras.Has("aperture")) {
    camera.lens = lens_of(source.extras);
    if (!camera.lens)
      losses.mention(
          "has an extra \"aperture\" that is not a length, or has no \"focusDistance\" with it: everything is sharp",
          node.name);
  }
  return camera;
}

}  // namespace penumbra::import
