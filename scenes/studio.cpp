// SPDX-License-Identifier: Apache-2.0
// Adds a floor, a light and a camera around a mesh or scene.

#include "scenes/studio.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace penumbra::scenes {
namespace {

template <typename Named>
std::string free_name(const std::vector<Named>& there, const std::string& wished) {
  std::string name = wished;
  for (int number = 2; std::ranges::find(there, name, &Named::name) != there.end(); ++number)
    name = fmt::format("{} {}", wished, number);
  return name;
}

/// Returns the area of upward-facing triangles in the plane of the lowest point: a body's own bottom faces downward.
double area_at_the_bottom(const Scene& scene, const Bounds& bounds) {
  const double tolerance = 1e-6 * glm::distance(bounds.low, bounds.high);
  double area = 0;
  for (const mesh::Triangle& triangle : scene.soup.triangles) {
    const auto corner = [&](std::size_t i) { return scene.soup.positions[triangle[i]]; };
    const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
    if (std::max({a.y, b.y, c.y}) > bounds.low.y + tolerance) continue;
    area += std::max((b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z), 0.0) / 2;
  }
  return area;
}

/// Returns whether something like a floor exists: half of the ground area below the scene lies in one plane.
bool has_floor(const Scene& scene, const Bounds& bounds) {
  const glm::dvec3 extent = bounds.high - bounds.low;
  return area_at_the_bottom(scene, bounds) > 0.5 * extent.x * extent.z;
}

void add_floor(Scene& scene, const Bounds& bounds) {
  const glm::dvec3 middle = bounds.middle();
  const double half = 4 * bounds.radius();
  const glm::dvec3 corner(middle.x - half, bounds.low.y, middle.z + half), right(2 * half, 0, 0), back(0, 0, -2 * half);
  const std::array corners = {corner, corner + right, corner + right + back, corner + back};
  constexpr std::array<mesh::Triangle, 2> kTriangles = {{{0, 1, 2}, {0, 2, 3}}};
  const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  Object floor;
  floor.name = free_name(scene.objects, "floor");
  scene.objects.push_back(std::move(floor));
  scene.soup.positions.insert(scene.soup.positions.end(), corners.begin(), corners.end());
  for (std::uint32_t i = 0; i < kTriangles.size(); ++i) {
    const auto& [a, b, c] = kTriangles.at(i);
    scene.soup.triangles.push_back({a + first, b + first, c + first});
    scene.soup.object.push_back(object);
    scene.soup.source_face.push_back(i);
  }
  const std::size_t count = scene.soup.positions.size();
  if (!scene.looks.normals.empty()) scene.looks.normals.resize(count, glm::vec3(0));
  if (!scene.looks.colors.empty()) scene.looks.colors.resize(count, glm::vec4(1));
  if (!scene.looks.places.empty()) scene.looks.places.resize(count, glm::dvec2(0));
  // The scene's origin is the centre of all meshes at rest, including the floor.
  if (scene.origin) {
    const Bounds floor_bounds = bounds_of(corners);
    scene.origin = (glm::min(bounds.low, floor_bounds.low) + glm::max(bounds.high, floor_bounds.high)) / 2.0;
  }
}

/// Returns an upright square that faces `target`.
Rectangle facing_square(const glm::dvec3& center, const glm::dvec3& target, double side) {
  glm::dvec3 normal = target - center;
  normal = glm::length(normal) > 0 ? glm::normalize(normal) : glm::dvec3(0, -1, 0);
  const glm::dvec3 up = std::abs(normal.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 u = glm::normalize(glm::cross(up, normal));
  return {center, 0.5 * side * u, 0.5 * side * glm::cross(normal, u)};
}

/// Returns the radiance that gives a surface at the target, facing the light, an irradiance of pi: a white surface
/// there has a radiance of 1.
double radiance_for(const LightShape& shape, const glm::dvec3& target) {
  const auto over = [](double distance, double area) { return std::numbers::pi * distance * distance / area; };
  if (const auto* rectangle = std::get_if<Rectangle>(&shape)) {
    const double area = 4 * glm::length(glm::cross(rectangle->half_u, rectangle->half_v));
    return over(glm::distance(rectangle->center, target), area);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const double distance = std::max(glm::distance(sphere->center, target), 2 * sphere->radius);
    return over(distance, std::numbers::pi * sphere->radius * sphere->radius);
  }
  if (std::holds_alternative<Dome>(shape)) return 1;
  const auto& sun = std::get<Sun>(shape);
  return sun.angle > 0 ? std::numbers::pi / irradiance_of_radiance(sun) : std::numbers::pi;
}

void add_light(Scene& scene, const std::string& name, LightShape shape, const glm::dvec3& target) {
  AreaLight light;
  light.name = free_name(scene.lights, name);
  light.radiance = glm::dvec3(std::clamp(radiance_for(shape, target), 1e-6, 1e12));
  light.shape = std::move(shape);
  scene.lights.push_back(std::move(light));
}

LightShape shape_of(const AddedLight& light, const glm::dvec3& target, bool sampled_domes) {
  switch (light.kind) {
    case AddedLight::Kind::rectangle:
      return facing_square(light.at, target, light.size);
    case AddedLight::Kind::sphere:
      return Sphere{light.at, light.size};
    case AddedLight::Kind::dome:
      return Dome{.sampled = sampled_domes};
    case AddedLight::Kind::sun:
      break;
  }
  return Sun{glm::normalize(light.at), light.size};
}

const char* name_of(AddedLight::Kind kind) {
  switch (kind) {
    case AddedLight::Kind::rectangle:
      return "rectangle";
    case AddedLight::Kind::sphere:
      return "sphere";
    case AddedLight::Kind::dome:
      return "dome";
    case AddedLight::Kind::sun:
      break;
  }
  return "sun";
}

}  // namespace

void put_in_studio(Scene& scene, const Scene& rest, const StudioWish& wish) {
  // Computed before the scene changes: `rest` may be the same object. If the scene has no positions, or also has
  // instances, then only a fully specified camera or domes were requested: the bounds do not matter for these.
  const Bounds bounds = rest.soup.positions.empty() ? Bounds() : bounds_of(rest.soup.positions);
  const bool on_floor = has_floor(rest, bounds);
  const glm::dvec3 middle = bounds.middle();
  const bool was_dark = scene.lights.empty(), was_unseen = scene.cameras.empty();
  std::string built;
  const auto put_in = [&](const char* what) { built += (built.empty() ? "" : ", ") + std::string(what); };
  for (const AddedLight& light : wish.lights)
    add_light(scene, name_of(light.kind), shape_of(light, middle, wish.sampled_domes), middle);
  if (!wish.never && (was_dark || wish.always)) {
    if (wish.lights.empty()) {
      const double radius = bounds.radius();
      const glm::dvec3 above = middle + radius * glm::dvec3(1, 2.5, 1.25);
      add_light(scene, "studio", facing_square(above, middle, radius), middle);
      put_in("one soft rectangle light");
    }
    if (wish.floor && !on_floor) {
      add_floor(scene, bounds);
      put_in("a floor below it");
    }
  }
  if (!wish.fit_camera.empty()) {
    Camera camera = camera_that_sees_all(bounds, wish.aspect);
    camera.name = wish.fit_camera;
    scene.cameras.insert(scene.cameras.begin(), std::move(camera));
  }
  if (wish.camera) scene.cameras.insert(scene.cameras.begin(), *wish.camera);
  if (was_unseen && scene.cameras.empty()) {
    scene.cameras.push_back(camera_that_sees_all(bounds, wish.aspect));
    if (built.empty()) {
      scene.warnings.emplace_back("there is no camera in the file; one that sees the whole scene was put in");
      return;
    }
    put_in("a camera that frames it");
  }
  if (built.empty()) return;
  scene.warnings.push_back(
      fmt::format("a studio was put around it: {} (--studio, --floor, --add-light and --camera choose it)", built));
}

}  // namespace penumbra::scenes
