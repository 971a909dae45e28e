#include "scenes/formats/checks.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

namespace penumbra::scenes {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

std::string show(const glm::dvec3& v) {
  return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

void check_position(const glm::dvec3& position, const std::string& where, const char* what) {
  if (!is_finite(position)) throw InputError("{}: {} is {}; expected finite numbers", where, what, show(position));
  if (largest(position) > kLargestCoordinate) {
    throw InputError("{}: {} is {}; coordinates beyond {:g} are not supported", where, what, show(position),
                     kLargestCoordinate);
  }
}

void check_radius(double radius, const std::string& where) {
  if (!std::isfinite(radius) || radius <= 0) {
    throw InputError("{}: the radius is {}; a light needs an area: expected a number above 0", where, radius);
  }
  if (radius > kLargestCoordinate)
    throw InputError("{}: the radius is {}; at most {:g}", where, radius, kLargestCoordinate);
}

/// Rectangle or Ellipse.
template <typename Halved>
void check_halves(const Halved& shape, const std::string& where) {
  check_position(shape.center, where, "center");
  check_position(shape.half_u, where, "halfU");
  check_position(shape.half_v, where, "halfV");
  const double u = glm::length(shape.half_u), v = glm::length(shape.half_v);
  // The cross product of parallel vectors is off by a few roundings of its terms, which are at most u · v.
  if (!(glm::length(glm::cross(shape.half_u, shape.half_v)) > 8 * kEpsilon * u * v)) {
    throw InputError("{}: the light has no area: halfU {} and halfV {} must be neither zero nor parallel", where,
                     show(shape.half_u), show(shape.half_v));
  }
}

void check_shape(const Rectangle& rectangle, const std::string& where) {
  check_halves(rectangle, where);
}

void check_shape(const Ellipse& ellipse, const std::string& where) {
  check_halves(ellipse, where);
}

void check_shape(const Disk& disk, const std::string& where) {
  check_position(disk.center, where, "center");
  check_position(disk.normal, where, "normal");
  if (glm::length(disk.normal) == 0) throw InputError("{}: the normal is zero; expected a direction", where);
  check_radius(disk.radius, where);
}

void check_shape(const Sphere& sphere, const std::string& where) {
  check_position(sphere.center, where, "center");
  check_radius(sphere.radius, where);
  if (!sphere.cone) return;
  const auto& [direction, inner, outer, smooth] = *sphere.cone;
  check_position(direction, where, "the cone's direction");
  if (glm::length(direction) == 0)
    throw InputError("{}: the cone's direction is zero; expected the way it shines", where);
  if (!(inner >= 0 && inner <= outer && outer > 0 && outer <= 90)) {
    throw InputError("{}: the cone reaches from {} to {} degrees; expected 0 <= inner <= outer <= 90, outer above 0",
                     where, inner, outer);
  }
}

void check_shape(const Sun& sun, const std::string& where) {
  check_position(sun.direction, where, "direction");
  if (glm::length(sun.direction) == 0)
    throw InputError("{}: the direction is zero; expected the way light travels", where);
  if (!(sun.angle >= 0 && sun.angle < 180)) {
    throw InputError("{}: the angle is {} degrees; expected the sun's apparent diameter, from 0 to less than 180",
                     where, sun.angle);
  }
}

void check_shape(const Polygon& polygon, const std::string& where) {
  const std::vector<glm::dvec3>& vertices = polygon.vertices;
  const std::size_t count = vertices.size();
  if (count < 3) throw InputError("{}: a polygon light needs at least 3 vertices; found {}", where, count);
  double magnitude = 0, perimeter = 0;
  glm::dvec3 centroid(0);
  for (std::size_t i = 0; i < count; ++i) {
    check_position(vertices[i], where, fmt::format("vertex {}", i).c_str());
    const glm::dvec3& next = vertices[(i + 1) % count];
    if (vertices[i] == next) {
      throw InputError("{}: vertices {} and {} are the same point {}; remove one", where, i, (i + 1) % count,
                       show(next));
    }
    magnitude = std::max(magnitude, largest(vertices[i]));
    perimeter += glm::distance(vertices[i], next);
    centroid += vertices[i] / static_cast<double>(count);
  }
  // Vertices of a flat polygon that was turned and stored in single precision stray by this much; what strays
  // further was not meant flat.
  const double tolerance = 16 * 0x1p-24 * magnitude;
  const glm::dvec3 normal = polygon_normal(polygon);
  double width = 0;  // across the longest direction, roughly: twice the area by the perimeter
  for (std::size_t i = 0; i < count; ++i) {
    width += glm::dot(normal, glm::cross(vertices[i] - centroid, vertices[(i + 1) % count] - centroid)) / perimeter;
  }
  if (!(width > kEpsilon * magnitude)) throw InputError("{}: the light has no area: its vertices lie on a line", where);
  for (std::size_t i = 0; i < count; ++i) {
    const double off = glm::dot(normal, vertices[i] - centroid);
    if (std::abs(off) > tolerance) {
      throw InputError("{}: the polygon is not flat: vertex {} {} lies {:.6g} off its plane", where, i,
                       show(vertices[i]), std::abs(off));
    }
  }
  // Convex: no vertex lies to the right of any edge (the sum of turns alone would accept a pentagram).
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    const glm::dvec3 inward = glm::normalize(glm::cross(normal, vertices[next] - vertices[i]));
    for (std::size_t j = 0; j < count; ++j) {
      const double off = -glm::dot(inward, vertices[j] - vertices[i]);
      if (off > tolerance) {
        throw InputError(
            "{}: the polygon is not convex: vertex {} {} lies {:.6g} outside the edge from vertex {} to {}", where, j,
            show(vertices[j]), off, i, next);
      }
    }
  }
}

void check_shape(const Pieces& shape, const std::string& where) {
  if (shape.pieces.empty()) throw InputError("{}: there are no pieces; a light needs at least one", where);
  for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
    const auto check = [&](const auto& piece) { check_shape(piece, fmt::format("{}/{}", where, i)); };
    std::visit(check, shape.pieces[i]);
    const auto* sphere = std::get_if<Sphere>(&shape.pieces[i]);
    if (sphere != nullptr && sphere->cone)
      throw InputError("{}/{}: a piece has no cone; make it a light of its own", where, i);
  }
}

}  // namespace

glm::dvec3 polygon_normal(const Polygon& polygon) {
  // Relative to the first vertex, so that a small polygon far from the origin keeps its digits.
  const std::vector<glm::dvec3>& vertices = polygon.vertices;
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    sum += glm::cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  }
  const double length = glm::length(sum);
  return length > 0 ? sum / length : sum;
}

void check_light(const AreaLight& light, const std::string& where) {
  std::visit([&](const auto& shape) { check_shape(shape, where); }, light.shape);
  if (light.texture && !std::holds_alternative<Rectangle>(light.shape)) {
    throw InputError("{}: only a rectangle light can have a texture", where);
  }
  constexpr double kBrightest = 1e36;  // sums over hundreds of lights stay below a float's largest number
  const auto [least, greatest] = std::minmax({light.radiance.x, light.radiance.y, light.radiance.z});
  if (!is_finite(light.radiance) || least < 0 || greatest > kBrightest)
    throw InputError("{}: the radiance is {}; expected numbers from 0 to {:g}", where, show(light.radiance),
                     kBrightest);
  if (!light.texture) return;
  glm::vec3 brightest(0);
  for (const glm::vec3& texel : light.texture->texels) brightest = glm::max(brightest, texel);
  if (largest(glm::dvec3(brightest) * light.radiance) > kBrightest) {
    throw InputError("{}: the radiance is {} and the texture's brightest texels {}; expected a product of at most {:g}",
                     where, show(light.radiance), show(glm::dvec3(brightest)), kBrightest);
  }
}

void check_camera(const Camera& camera, const std::string& where) {
  check_position(camera.eye, where, "eye");
  check_position(camera.target, where, "target");
  check_position(camera.up, where, "up");
  if (camera.eye == camera.target) {
    throw InputError("{}: eye and target are the same point {}; the camera must look somewhere", where,
                     show(camera.eye));
  }
  const glm::dvec3 view = camera.target - camera.eye;
  const double view_length = glm::length(view), up_length = glm::length(camera.up);
  if (up_length == 0) throw InputError("{}: up is zero; expected a direction such as [0, 1, 0]", where);
  if (!(glm::length(glm::cross(view / view_length, camera.up / up_length)) > 8 * kEpsilon)) {
    throw InputError("{}: up {} points along the view direction; choose another, such as [0, 0, -1]", where,
                     show(camera.up));
  }
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180)) {
    throw InputError("{}: the vertical field of view is {} degrees; expected more than 0 and less than 180", where,
                     camera.vertical_fov);
  }
  constexpr double kFarthestShift = 1000;  // a lens that looks so far aside shows hardly anything
  if (!(std::abs(camera.shift.x) <= kFarthestShift && std::abs(camera.shift.y) <= kFarthestShift)) {
    throw InputError("{}: the shift is ({}, {}); expected up to {} heights of the picture", where, camera.shift.x,
                     camera.shift.y, kFarthestShift);
  }
}

void check_scene(const Scene& scene, const std::string& where, bool needs_light) {
  const mesh::TriangleSoup& soup = scene.soup;
  if (soup.triangles.empty()) throw InputError("{}: the scene has no triangles; it needs at least one mesh", where);
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
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (triangles_of[i] == 0) throw InputError("{}: mesh \"{}\" has no triangles", where, scene.objects[i].name);
  }
  if (scene.lights.empty() && needs_light) {
    throw InputError(
        "{}: the scene has no area light; it needs at least one (glTF: a flat mesh with an emissive material)", where);
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
