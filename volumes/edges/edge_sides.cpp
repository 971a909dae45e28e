// SPDX-License-Identifier: Apache-2.0
// Chooses the edge records of a light: with or without its body, and cut at its plane if something lies behind it.

#include "volumes/edges/edge_sides.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::volumes {
namespace {

/// Returns the light's plane from its stored points, in double, and the frame's rectangle in it.
LightSide front_of_light(const visibility::Light& light, const visibility::DeviceLight& frame, float scale) {
  const auto [center, u, v] = visibility::light_frame(light);
  const std::array plane{center, glm::dvec3(light.center_u), glm::dvec3(light.center_v)};
  if (is_parallelogram(light.kind)) {
    return {plane, center, u, v, 1, scale};
  }
  const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
  const auto in_plane = [&](const glm::dvec3& d) { return d - normal * glm::dot(normal, d); };
  const double unscaled = 1 / static_cast<double>(scale);
  return {plane,
          center + in_plane(glm::dvec3(frame.center) * unscaled - center),
          in_plane(glm::dvec3(frame.u) * unscaled),
          in_plane(glm::dvec3(frame.v) * unscaled),
          1,
          scale};
}

}  // namespace

void EdgeSides::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  casters_ = edge_casters(scene, -1);
  casters_without_ = -1;
}

LightEdges EdgeSides::prepare_light(const visibility::Light& light, const visibility::DeviceLight& frame, float scale) {
  LightEdges edges;
  edges.has_body = std::find(scene_->emits.begin(), scene_->emits.end(), light.index) != scene_->emits.end();
  const std::int32_t without = edges.has_body ? light.index : -1;
  if (casters_without_ != without) {
    casters_ = edge_casters(*scene_, without);
    casters_without_ = without;
  }
  if (!visibility::is_planar(light.kind)) return edges;
  visibility::check_size(light, frame, method_);
  const LightSide front = front_of_light(light, frame, scale);
  if (!reaches_behind(*scene_, front)) return edges;
  edges.front = front;
  if (light.two_sided) {
    edges.back = front;
    edges.back->sign = -1;
  }
  return edges;
}

}  // namespace penumbra::volumes
