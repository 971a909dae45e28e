// SPDX-License-Identifier: Apache-2.0
// View samples: the visible point of each pixel, in double arithmetic on the scene floats; the definition that a
// rasteriser has to match.

#include "visibility/view_samples.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/pages.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <CGAL/MP_Float.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra::visibility {
namespace {

/// Intersection of the pixel's ray with the triangle's plane, computed from the sorted vertices.
struct PlaneHit {
  double t = 0;           // distance along the view axis
  double eye_height = 0;  // normal · (eye − a): positive if the normal points to the viewer's side
};

/// `normal`: (b − a) × (c − a).
std::optional<PlaneHit> meet_plane(const ViewRay& ray, const glm::dvec3& a, const glm::dvec3& normal) {
  PlaneHit hit;
  hit.eye_height = glm::dot(normal, ray.start - a);
  const double descent = -glm::dot(normal, ray.direction);
  if (descent == 0) return std::nullopt;
  hit.t = hit.eye_height / descent;
  if (!(hit.t > 0) || !std::isfinite(hit.t)) return std::nullopt;
  return hit;
}

/// Returns the exact side of the sorted triangle's plane that the ray's start is on; if it is exactly on the plane
/// (seen edge-on, covered by rounding alone), the side given by rounding.
std::int8_t facing_of(const ViewRay& ray, const mesh::SidesOfPlane& sides, double eye_height) {
  const Side side = sides(ray.start);
  if (side != Side::on) return static_cast<std::int8_t>(side);
  return eye_height > 0 ? std::int8_t{1} : std::int8_t{-1};
}

/// Returns whether the whole sphere is strictly above the carrier's plane: n · (c − a) > r |n|, in double (a radius is
/// not a float32).
bool sphere_above(const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const Light& light) {
  const glm::dvec3 a = carrier[0];
  const glm::dvec3 normal = glm::cross(glm::dvec3(carrier[1]) - a, glm::dvec3(carrier[2]) - a);
  return facing * glm::dot(normal, glm::dvec3(light.center) - a) > light.radius * glm::length(normal);
}

/// n · d, n = (b − a) × (c − a), and a bound of its error: two differences, their products, the differences of those,
/// three more products and two sums are off by at most 8 · 2⁻⁵³ of the sum of all terms' magnitudes; the bound is twice
/// that.
struct Height {
  double value, error;
};
Height height_along(const std::array<glm::vec3, 3>& carrier, const glm::vec3& d) {
  const glm::dvec3 a = carrier[0], b = glm::dvec3(carrier[1]) - a, c = glm::dvec3(carrier[2]) - a;
  const glm::dvec3 wide_b = glm::abs(b), wide_c = glm::abs(c), wide_d = glm::abs(glm::dvec3(d));
  const glm::dvec3 terms(wide_b.y * wide_c.z + wide_b.z * wide_c.y, wide_b.z * wide_c.x + wide_b.x * wide_c.z,
                         wide_b.x * wide_c.y + wide_b.y * wide_c.x);
  return {glm::dot(glm::cross(b, c), glm::dvec3(d)), 16 * 0x1p-53 * glm::dot(terms, wide_d)};
}

/// Returns whether the whole cone of a sun is strictly above the carrier's plane: n · c > tan |(n · u, n · v)|, exactly
/// for the stored values.
bool cone_above(const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const Light& light) {
  const Height over = height_along(carrier, light.center), to_u = height_along(carrier, light.sun->axis_u),
               to_v = height_along(carrier, light.sun->axis_v);
  const double far = light.sun->tangent * std::hypot(to_u.value, to_v.value), above = facing * over.value - far;
  const double error =
      over.error + light.sun->tangent * (to_u.error + to_v.error) + 8 * 0x1p-53 * (std::abs(over.value) + far);
  if (std::abs(above) > error) return above > 0;
  using Number = CGAL::MP_Float;
  const auto along = [&](const glm::vec3& d) {  // det(b − a, c − a, d)
    const auto edge = [&](std::size_t corner, int axis) {
      return Number(carrier[corner][axis]) - Number(carrier[0][axis]);
    };
    Number sum(0);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      sum += Number(d[i]) * (edge(1, j) * edge(2, k) - edge(1, k) * edge(2, j));
    }
    return sum;
  };
  const Number middle = along(light.center) * Number(static_cast<double>(facing));
  if (CGAL::sign(middle) != CGAL::POSITIVE) return false;
  const Number u = along(light.sun->axis_u), v = along(light.sun->axis_v), tangent(light.sun->tangent);
  return CGAL::sign(middle * middle - tangent * tangent * (u * u + v * v)) == CGAL::POSITIVE;
}

/// Classifies pixels for one light. Neighbours mostly have the same carrier, and most of the classification depends on
/// the carrier alone.
class Classifier {
 public:
  Classifier(const SceneFloats& scene, const ViewSamples& samples, const Light& light)
      : scene_(scene), samples_(samples), light_(light) {
    if (is_planar(light.kind)) plane_.emplace(light.center, light.center_u, light.center_v);
  }

  /// The carrier of the view sample classified last, as seen from one side.
  struct Carrier {
    std::int32_t triangle = ViewSamples::kBackground;
    std::int8_t facing = 0;
    PixelClass anywhere = PixelClass::background;  ///< class of all its points; judged: it depends on p
    std::optional<PixelClass> in_front = {};       ///< for p in front of the light; nullopt: not yet computed
  };
  [[nodiscard]] PixelClass operator()(std::size_t pixel, Carrier& last) const;

 private:
  [[nodiscard]] bool in_front(const glm::vec3& p) const {
    if (!plane_) return in_front_of_light(light_, p);
    const Side side = (*plane_)(p);
    return light_.two_sided ? side != Side::on : side == Side::front;
  }
  [[nodiscard]] PixelClass class_anywhere(std::int32_t triangle) const;
  [[nodiscard]] PixelClass class_in_front(std::uint32_t carrier, std::int8_t facing) const;

  const SceneFloats& scene_;
  const ViewSamples& samples_;
  const Light& light_;
  std::optional<mesh::SidesOfPlane> plane_;
};

PixelClass Classifier::class_anywhere(std::int32_t triangle) const {
  if (triangle == ViewSamples::kBackground) return PixelClass::background;
  const auto carrier = static_cast<std::uint32_t>(triangle);
  if (scene_.emits[carrier] == light_.index) return PixelClass::emitter;
  if (!is_lit_by(scene_, light_, carrier)) return PixelClass::unlit;
  return is_receiver(scene_, light_, carrier) ? PixelClass::judged : PixelClass::unshadowed;
}

PixelClass Classifier::class_in_front(std::uint32_t carrier, std::int8_t facing) const {
  if (scene_.emits[carrier] >= 0) return PixelClass::other_body;
  if (is_dome(light_.kind)) return PixelClass::judged;  // a dome's V depends only on the part above the plane
  const std::array<glm::vec3, 3> corners = scene_.corners(carrier);
  if (light_.sun) return cone_above(corners, facing, light_) ? PixelClass::judged : PixelClass::horizon;
  if (is_body(light_.kind)) return sphere_above(corners, facing, light_) ? PixelClass::judged : PixelClass::horizon;
  const mesh::SidesOfPlane sides(corners[0], corners[1], corners[2]);
  const Side above = facing > 0 ? Side::front : Side::back;
  const bool all = std::ranges::all_of(light_.outline, [&](const glm::vec3& corner) { return sides(corner) == above; });
  return all ? PixelClass::judged : PixelClass::horizon;
}

PixelClass Classifier::operator()(std::size_t pixel, Carrier& last) const {
  const std::int32_t triangle = samples_.triangle[pixel];
  const std::int8_t facing = samples_.facing[pixel];
  if (triangle != last.triangle || facing != last.facing) last = {triangle, facing, class_anywhere(triangle)};
  if (last.anywhere != PixelClass::judged) return last.anywhere;
  if (!in_front(samples_.p[pixel])) return PixelClass::behind;
  if (!last.in_front) last.in_front = class_in_front(static_cast<std::uint32_t>(triangle), facing);
  return *last.in_front;
}

/// Calls `body` for each pixel, with a `Last` that consecutive neighbouring pixels share.
template <typename Last, typename Body>
void for_each_pixel(const ViewSamples& samples, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      Last last;
                      for (std::size_t pixel = range.begin(); pixel != range.end(); ++pixel) body(pixel, last);
                    });
}

/// The plane that carried the last view sample, the start of the ray that met it, and the side that was seen.
struct CarrierPlane {
  std::int32_t triangle = ViewSamples::kBackground;
  glm::dvec3 corner{0};
  std::optional<mesh::SidesOfPlane> sides;
  glm::dvec3 start{0};
  std::int8_t facing = 0;  ///< from `start`; 0: not yet computed
  glm::vec3 n{0};          ///< on that side
};

}  // namespace

double PinholeCamera::across(std::uint32_t x) const {
  const double aspect = static_cast<double>(width) / picture_height();
  return (2 * (x + 0.5) / width - 1) * aspect;
}

double PinholeCamera::upward(std::uint32_t y) const {
  return 1 - 2 * (first_row + y + 0.5) / picture_height();
}

glm::dvec3 PinholeCamera::direction(std::uint32_t x, std::uint32_t y) const {
  return middle + (across(x) * right + upward(y) * up) * tan_half_fov;
}

ViewRay PinholeCamera::ray(std::uint32_t x, std::uint32_t y) const {
  const ViewRay sharp = half_height ? ViewRay{eye + (across(x) * right + upward(y) * up) * *half_height, forward}
                                    : ViewRay{eye, direction(x, y)};
  if (!lens) return sharp;
  const glm::dvec2 at = lens->point(x, first_row + y);
  const glm::dvec3 aside = at.x * right + at.y * up;
  return {sharp.start + aside, sharp.direction - aside / lens->focus_distance};
}

glm::dvec3 PinholeCamera::screen_across() const {
  return (right - glm::dot(right, middle) * forward) / (tan_half_fov * width / picture_height());
}

glm::dvec3 PinholeCamera::screen_upward() const {
  return (up - glm::dot(up, middle) * forward) / tan_half_fov;
}

PinholeCamera make_camera(const scenes::Camera& camera, const glm::dvec3& origin, std::uint32_t width,
                          std::uint32_t height) {
  const glm::dvec3 view = camera.target - camera.eye;
  const double distance = glm::length(view);
  if (!(distance > 0) || !std::isfinite(distance)) {
    throw InputError("camera \"{}\": eye ({}, {}, {}) and target must be two different finite points", camera.name,
                     camera.eye.x, camera.eye.y, camera.eye.z);
  }
  if (camera.height && !(*camera.height > 0 && std::isfinite(*camera.height))) {
    throw InputError("camera \"{}\": an orthographic picture {} high; it must be above 0", camera.name, *camera.height);
  }
  if (!camera.height && !(camera.vertical_fov > 0 && camera.vertical_fov < 180)) {
    throw InputError("camera \"{}\": vertical field of view is {} degrees; it must be between 0 and 180", camera.name,
                     camera.vertical_fov);
  }
  if (width == 0 || height == 0)
    throw InputError("camera \"{}\": an image of {}x{} has no pixels", camera.name, width, height);
  PinholeCamera result;
  result.eye = camera.eye - origin;
  result.forward = view / distance;
  const glm::dvec3 right = glm::cross(result.forward, camera.up);
  // Each component of the product is off by at most two roundings of |up|: below that, its direction is noise.
  constexpr double kNoise = 4 * std::numeric_limits<double>::epsilon();
  if (!(glm::length(right) > kNoise * glm::length(camera.up))) {
    throw InputError("camera \"{}\": up ({}, {}, {}) is zero or parallel to the view direction", camera.name,
                     camera.up.x, camera.up.y, camera.up.z);
  }
  result.right = glm::normalize(right);
  // The rounding of so short a product has a component along `forward`, but places on the screen require orthogonal
  // axes.
  if (glm::length(right) < 0x1p-16 * glm::length(camera.up))
    result.right = glm::normalize(result.right - glm::dot(result.right, result.forward) * result.forward);
  result.up = glm::cross(result.right, result.forward);
  if (camera.height)
    result.half_height = *camera.height / 2;
  else
    result.tan_half_fov = std::tan(glm::radians(camera.vertical_fov) / 2);
  result.middle = result.forward;
  if (camera.shift != glm::dvec2(0)) {
    const double height_seen = 2 * result.half_height.value_or(result.tan_half_fov);
    (camera.height ? result.eye : result.middle) +=
        height_seen * (camera.shift.x * result.right + camera.shift.y * result.up);
  }
  result.width = width;
  result.height = height;
  return result;
}

std::optional<double> cover(const ViewRay& ray, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a = glm::dvec3(corners[0]) - ray.start, b = glm::dvec3(corners[1]) - ray.start,
                   c = glm::dvec3(corners[2]) - ray.start;
  // Sides of the ray on which the edges pass. The sorted vertices give a→b, b→c and a→c as the edges' unique
  // directions, for every triangle; the cycle around the triangle takes a→c backwards.
  const double ab = glm::dot(ray.direction, glm::cross(a, b)), bc = glm::dot(ray.direction, glm::cross(b, c)),
               ca = -glm::dot(ray.direction, glm::cross(a, c));
  const bool left = ab >= 0 && bc >= 0 && ca >= 0, right = ab <= 0 && bc <= 0 && ca <= 0;
  if (left == right) return std::nullopt;  // no common side; or all zero: edge-on or without area
  const glm::dvec3 first = corners[0];
  const std::optional<PlaneHit> hit =
      meet_plane(ray, first, glm::cross(glm::dvec3(corners[1]) - first, glm::dvec3(corners[2]) - first));
  if (!hit) return std::nullopt;
  return hit->t;
}

bool may_carry(const SceneFloats& scene, std::uint32_t triangle, const ViewRay& ray) {
  const scenes::Alpha::Mode mode = alpha_mode(scene, triangle);
  if (mode != scenes::Alpha::Mode::mask) return mode == scenes::Alpha::Mode::opaque;
  return transmittance_at(scene, triangle, shares_on_line(ray.start, ray.direction, scene.corners(triangle))) == 0;
}

ViewSamples complete_view_samples(const SceneFloats& scene, const PinholeCamera& camera,
                                  std::vector<std::int32_t> triangles) {
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  PENUMBRA_ASSERT(triangles.size() == pixels, "{} triangles for {} pixels", triangles.size(), pixels);
  ViewSamples samples;
  samples.width = camera.width;
  samples.height = camera.height;
  samples.camera = camera;
  samples.eye = glm::vec3(camera.eye);
  samples.triangle = std::move(triangles);
  resize_on_all_cores(samples.p, pixels);  // 0 for background
  resize_on_all_cores(samples.n, pixels);
  resize_on_all_cores(samples.depth, pixels);
  samples.facing.assign(pixels, 0);
  for_each_pixel<CarrierPlane>(samples, [&](std::size_t pixel, CarrierPlane& last) {
    std::int32_t& triangle = samples.triangle[pixel];
    if (triangle == ViewSamples::kBackground) return;
    if (triangle != last.triangle) {
      const std::array<glm::vec3, 3> corners = scene.corners(static_cast<std::uint32_t>(triangle));
      last.triangle = triangle;
      last.corner = corners[0];
      last.sides.emplace(corners[0], corners[1], corners[2]);
      last.facing = 0;
    }
    const auto x = static_cast<std::uint32_t>(pixel % camera.width),
               y = static_cast<std::uint32_t>(pixel / camera.width);
    const ViewRay ray = camera.ray(x, y);
    const std::optional<PlaneHit> hit = meet_plane(ray, last.corner, last.sides->normal());
    const glm::vec3 p = hit ? glm::vec3(ray.start + hit->t * ray.direction) + 0.0f : glm::vec3(0);
    if (!hit || !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      triangle = ViewSamples::kBackground;  // the rasteriser's triangle is edge-on: the ray meets its plane only at
                                            // infinity
      return;
    }
    if (last.facing == 0 || last.start != ray.start) {  // rays of a lens, and parallel rays, have different starts
      last.start = ray.start;
      last.facing = facing_of(ray, *last.sides, hit->eye_height);
      last.n = glm::vec3(glm::normalize(last.sides->normal() * static_cast<double>(last.facing))) + 0.0f;
    }
    samples.p[pixel] = p;
    samples.facing[pixel] = last.facing;
    samples.n[pixel] = last.n;
    samples.depth[pixel] = static_cast<float>(hit->t);
  });
  return samples;
}

std::int32_t carrier_of(const SceneFloats& scene, const PinholeCamera& camera, std::uint32_t x, std::uint32_t y) {
  const ViewRay ray = camera.ray(x, y);
  double nearest = std::numeric_limits<double>::infinity();
  std::int32_t carrier = ViewSamples::kBackground;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.plane[i] == SceneFloats::kNoPlane) continue;
    const std::optional<double> t = cover(ray, scene.corners(i));
    if (!t || *t > nearest) continue;
    if (*t == nearest && !scene.comes_before(i, static_cast<std::uint32_t>(carrier))) continue;
    if (!may_carry(scene, i, ray)) continue;
    nearest = *t;
    carrier = static_cast<std::int32_t>(i);
  }
  return carrier;
}

ViewSamples brute_force_view_samples(const SceneFloats& scene, const PinholeCamera& camera) {
  std::vector<std::int32_t> carriers(static_cast<std::size_t>(camera.width) * camera.height, ViewSamples::kBackground);
  tbb::parallel_for(std::uint32_t{0}, camera.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < camera.width; ++x)
      carriers[static_cast<std::size_t>(y) * camera.width + x] = carrier_of(scene, camera, x, y);
  });
  return complete_view_samples(scene, camera, std::move(carriers));
}

std::vector<PixelClass> classify_pixels(const SceneFloats& scene, const ViewSamples& samples, const Light& light) {
  std::vector<PixelClass> classes(samples.size());
  const Classifier classify(scene, samples, light);
  for_each_pixel<Classifier::Carrier>(
      samples, [&](std::size_t pixel, Classifier::Carrier& last) { classes[pixel] = classify(pixel, last); });
  return classes;
}

}  // namespace penumbra::visibility
