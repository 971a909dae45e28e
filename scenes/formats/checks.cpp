// SPDX-License-Identifier: Apache-2.0
// Checks scenes of every format for the properties that methods rely on: finite numbers, coordinates and sums of
// radiance within float's range, and cameras with a view direction.

#include "scenes/formats/checks.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace penumbra::scenes {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Requires instances whose boxes are within the range of coordinates; counts their triangles.
void check_instances(const Scene& scene, const Instances& instances, const std::string& where,
                     std::vector<std::size_t>& triangles_of) {
  std::vector<std::pair<glm::dvec3, glm::dvec3>> boxes;
  for (const auto& mesh : instances.meshes) {
    const std::vector<glm::dvec3>& positions = mesh->soup.positions;
    PENUMBRA_ASSERT(!positions.empty(), "mesh {} of instances is empty", boxes.size());
    auto& [low, high] = boxes.emplace_back(positions.front(), positions.front());
    for (const glm::dvec3& position : positions) low = glm::min(low, position), high = glm::max(high, position);
  }
  for (std::size_t i = 0; i < instances.all.size(); ++i) {
    const Instance& instance = instances.all[i];
    PENUMBRA_ASSERT(instance.mesh < boxes.size() && instance.object < scene.objects.size(), "instance {} is of mesh {}",
                    i, instance.mesh);
    triangles_of[instance.object] += instances.triangles_of(instance);
    const auto& [low, high] = boxes[instance.mesh];
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 own((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                           (corner & 4) != 0 ? high.z : low.z);
      check_position(instance.placement(own),
                     fmt::format("{}: mesh \"{}\"", where, scene.objects[instance.object].name),
                     fmt::format("a corner of the box around instance {}", i).c_str());
    }
  }
}

}  // namespace

std::string show_vector(const glm::dvec3& v) {
  return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

void check_position(const glm::dvec3& position, const std::string& where, const char* what) {
  if (!is_finite(position))
    throw InputError("{}: {} is {}; expected finite numbers", where, what, show_vector(position));
  if (largest(position) > kLargestCoordinate) {
    throw InputError("{}: {} is {}; coordinates beyond {:g} are not supported", where, what, show_vector(position),
                     kLargestCoordinate);
  }
}

void check_light(const AreaLight& light, const std::string& where) {
  check_light_shape(light.shape, where);
  if (light.texture && !std::holds_alternative<Rectangle>(light.shape) && !std::holds_alternative<Dome>(light.shape)) {
    throw InputError("{}: only a rectangle or a dome can have a picture", where);
  }
  constexpr double kBrightest = 1e36;  // sums over hundreds of lights stay below a float's largest number
  const auto [least, greatest] = std::minmax({light.radiance.x, light.radiance.y, light.radiance.z});
  if (!is_finite(light.radiance) || least < 0 || greatest > kBrightest)
    throw InputError("{}: the radiance is {}; expected numbers from 0 to {:g}", where, show_vector(light.radiance),
                     kBrightest);
  if (!light.texture) return;
  glm::vec3 brightest(0);
  for (const glm::vec3& texel : light.texture->texels) brightest = glm::max(brightest, texel);
  if (largest(glm::dvec3(brightest) * light.radiance) > kBrightest) {
    throw InputError("{}: the radiance is {} and the texture's brightest texels {}; expected a product of at most {:g}",
                     where, show_vector(light.radiance), show_vector(glm::dvec3(brightest)), kBrightest);
  }
}

void check_camera(const Camera& camera, const std::string& where) {
  check_position(camera.eye, where, "eye");
  check_position(camera.target, where, "target");
  check_position(camera.up, where, "up");
  if (camera.eye == camera.target) {
    throw InputError("{}: eye and target are the same point {}; the camera must look somewhere", where,
                     show_vector(camera.eye));
  }
  const glm::dvec3 view = camera.target - camera.eye;
  const double view_length = glm::length(view), up_length = glm::length(camera.up);
  if (up_length == 0) throw InputError("{}: up is zero; expected a direction such as [0, 1, 0]", where);
  if (!(glm::length(glm::cross(view / view_length, camera.up / up_length)) > 8 * kEpsilon)) {
    throw InputError("{}: up {} points along the view direction; choose another, such as [0, 0, -1]", where,
                     show_vector(camera.up));
  }
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180)) {
    throw InputError("{}: the vertical field of view is {} degrees; expected more than 0 and less than 180", where,
                     camera.vertical_fov);
  }
  constexpr double kFarthestShift = 1000;  // a larger shift shows hardly anything
  if (!(std::abs(camera.shift.x) <= kFarthestShift && std::abs(camera.shift.y) <= kFarthestShift)) {
    throw InputError("{}: the shift is ({}, {}); expected up to {} heights of the picture", where, camera.shift.x,
                     camera.shift.y, kFarthestShift);
  }
  if (!camera.lens) return;
  const auto is_length = [](double x) { return x > 0 && x <= kLargestCoordinate; };
  if (!is_length(camera.lens->radius))
    throw InputError("{}: the aperture is {}; expected a lens's radius above 0", where, camera.lens->radius);
  if (!is_length(camera.lens->focus_distance))
    throw InputError("{}: the focus distance is {}; expected a length above 0", where, camera.lens->focus_distance);
}

void check_scene(const Scene& scene, const std::string& where, bool needs_light, const Instances& instances) {
  const mesh::TriangleSoup& soup = scene.soup;
  if (soup.triangles.empty() && instances.empty())
    throw InputError("{}: the scene has no triangles; it needs at least one mesh", where);
  const bool all_near =
      std::ranges::all_of(soup.positions, [](const glm::dvec3& p) { return largest(p) <= kLargestCoordinate; });
  std::vector<std::size_t> triangles_of(scene.objects.size(), 0);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const std::uint32_t object = soup.object[i];
    PENUMBRA_ASSERT(object < scene.objects.size(), "triangle {} belongs to object {}", i, object);
    ++triangles_of[object];
    for (const std::uint32_t vertex : soup.triangles[i]) {
      PENUMBRA_ASSERT(vertex < soup.positions.size(), "triangle {} uses vertex {}", i, vertex);
      if (all_near) continue;
      const glm::dvec3& position = soup.positions[vertex];
      if (largest(position) <= kLargestCoordinate) continue;  // false for NaN
      check_position(position, fmt::format("{}: mesh \"{}\"", where, scene.objects[object].name),
                     fmt::format("a vertex of face {}", soup.source_face[i]).c_str());
    }
  }
  check_instances(scene, instances, where, triangles_of);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (triangles_of[i] == 0) throw InputError("{}: mesh \"{}\" has no triangles", where, scene.objects[i].name);
  }
  if (scene.lights.empty() && needs_light) {
    throw InputError(
        "{}: there is no light in the scene; it needs at least one (glTF: a flat mesh with an emissive material, or a "
        "point, spot or sun lamp)",
        where);
  }
  std::set<std::string> names;
  for (const AreaLight& light : scene.lights) {
    check_light(light, fmt::format("{}: light \"{}\"", where, light.name));
    if (!names.insert(light.name).second) {
      throw InputError("{}: two lights are named \"{}\"; names of lights must differ", where, light.name);
    }
  }
  if (scene.cameras.empty()) throw InputError("{}: the scene has no camera; it needs at least one", where);
  for (const Camera& camera : scene.cameras) check_camera(camera, fmt::format("{}: camera \"{}\"", where, camera.name));
}

}  // namespace penumbra::scenes
