// SPDX-License-Identifier: Apache-2.0
// Computes the body seen by a camera (clipping by Sutherland and Hodgman 1974) and the closed forms of fits: split
// depths (Zhang et al. 2006), LiSPSM (Wimmer et al. 2004), TSM (Martin and Tan 2004), snapped windows.

#include "maps/host/view_fit.hpp"

#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace penumbra::maps {
namespace {

/// Plane whose inner side is dot(normal, x) + offset >= 0.
struct Plane {
  glm::dvec3 normal;
  double offset;

  [[nodiscard]] double of(const glm::dvec3& x) const { return glm::dot(normal, x) + offset; }
};

/// Returns the planes of a picture's frustum between two depths.
std::vector<Plane> frustum(const visibility::PinholeCamera& camera, double from, double to) {
  const auto through = [&](const glm::dvec3& normal, double offset) {
    return Plane{normal, offset - glm::dot(normal, camera.eye)};
  };
  std::vector<Plane> planes{through(camera.forward, -std::max(from, 0.0))};
  if (std::isfinite(to)) planes.push_back(through(-camera.forward, to));
  if (camera.half_height) {
    const double up = *camera.half_height, across = up * camera.width / std::max(camera.height, 1U);
    for (const double sign : {-1.0, 1.0}) {
      planes.push_back(through(sign * camera.right, across));
      planes.push_back(through(sign * camera.up, up));
    }
    return planes;
  }
  for (const double sign : {-1.0, 1.0}) {
    planes.push_back(through(camera.forward + sign * camera.screen_across(), 0));
    planes.push_back(through(camera.forward + sign * camera.screen_upward(), 0));
  }
  return planes;
}

/// Returns the part of a polygon on a plane's inner side (Sutherland and Hodgman 1974).
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& polygon, const Plane& plane) {
  std::vector<glm::dvec3> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = plane.of(a), at_b = plane.of(b);
    if (at_a >= 0) inside.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) inside.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return inside;
}

std::vector<BodyPoint> points_in_frustum(const visibility::SceneFloats& scene, const visibility::Light& light,
                                         const LightBasis& basis, const visibility::PinholeCamera& camera, double from,
                                         double to, const SceneSpace& space) {
  std::vector<Plane> planes = frustum(camera, from, to);
  for (Plane& plane : planes) {
    const glm::dvec4 here = space.plane({plane.normal, plane.offset});
    plane = {glm::dvec3(here), here.w};
  }
  // A polygon cut by the light's plane becomes two, each up to this distance from the plane.
  const double gap = 0x1p-20 * glm::length(glm::dvec3(scene.upper) - glm::dvec3(scene.lower));
  const double height = glm::dot(basis.n, basis.center);
  const Plane before{basis.n, -height - gap}, behind{-basis.n, height - gap};
  std::vector<BodyPoint> points;
  const auto add = [&](const glm::dvec3& x) {
    points.push_back({x, glm::dot(camera.forward, space.scene_point(x) - camera.eye)});
  };
  std::vector<std::uint8_t> whole(scene.positions.size(), 0);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (!visibility::is_receiver(scene, light, i)) continue;
    std::vector<glm::dvec3> polygon;
    for (const glm::vec3& corner : scene.corners(i)) polygon.emplace_back(corner);
    const auto lies_within = [&](const Plane& plane) {
      return std::ranges::all_of(polygon, [&](const glm::dvec3& corner) { return plane.of(corner) >= 0; });
    };
    const bool cut = !lies_within(before) && !lies_within(behind);
    if (!cut && std::ranges::all_of(planes, lies_within)) {
      for (const std::uint32_t corner : scene.triangles[i]) whole[corner] = 1;
      continue;
    }
    for (const Plane& plane : planes) {
      polygon = clipped(polygon, plane);
      if (polygon.empty()) break;
    }
    if (cut) {
      std::ranges::for_each(clipped(polygon, before), add);
      std::ranges::for_each(clipped(polygon, behind), add);
    } else {
      std::ranges::for_each(polygon, add);
    }
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] != 0) add(scene.positions[i]);
  }
  return points;
}

}  // namespace

std::vector<visibility::OptionDescription> view_fit_descriptions() {
  return {kFit.description(),     kViewBody.description(),   kSnap.description(),     kCascades.description(),
          kSplit.description(),   kSplitShare.description(), kTiles.description(),    kRefine.description(),
          kChanged.description(), kFocus.description(),      kAliasing.description(), kProjection.description()};
}

std::vector<visibility::OptionDescription> window_fit_descriptions() {
  return {kWindowFit.description(), kViewBody.description(), kSnap.description()};
}

std::string words_of(const ViewFit& fit) {
  if (fit.projection != Projection::window) return std::string("projection=") + kProjection.name_of(fit.projection);
  return std::string("fit=") + kFit.name_of(fit.fit);
}

ViewFit view_fit(std::span<const visibility::OptionDescription> options, const visibility::ParsedOptions& parsed) {
  const auto has = [&](std::string_view name) {
    return std::ranges::find(options, name, &visibility::OptionDescription::name) != options.end();
  };
  ViewFit fit;
  if (!has(kFit.name())) return fit;
  fit.body = parsed[kViewBody];
  fit.snap = parsed[kSnap];
  if (!has(kCascades.name())) {
    fit.fit = parsed[kWindowFit];
    return fit;
  }
  fit.aliasing = parsed[kAliasing];
  fit.fit = parsed[kFit];
  fit.projection = parsed[kProjection];
  fit.cascades = parsed[kCascades];
  fit.split = parsed[kSplit];
  fit.split_share = parsed[kSplitShare];
  fit.tiles = parsed[kTiles];
  fit.refine = parsed[kRefine];
  fit.changed = parsed[kChanged];
  fit.focus = parsed[kFocus];
  return fit;
}

std::vector<BodyPoint> body_points(const visibility::SceneFloats& scene, const visibility::Light& light,
                                   const LightBasis& basis, const visibility::ViewSamples& samples, ViewBody body,
                                   double from, double to, const SceneSpace& space) {
  if (body == ViewBody::frustum) return points_in_frustum(scene, light, basis, samples.camera, from, to, space);
  std::vector<BodyPoint> points;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!visibility::is_receiver(scene, light, samples, i)) continue;
    const glm::dvec3 p(samples.p[i]);
    const double depth = glm::dot(samples.camera.forward, space.scene_point(p) - samples.camera.eye);
    if (depth >= from && depth <= to) points.push_back({p, depth});
  }
  return points;
}

std::vector<double> split_depths(const ViewFit& fit, double near, double far, std::uint32_t slices) {
  std::vector<double> depths{near};
  const double pseudo = near + fit.split_share * (far - near);
  for (std::uint32_t i = 1; i < slices; ++i) {
    const double share = static_cast<double>(i) / slices;
    const double logarithmic = near * std::pow(far / near, share), uniform = near + (far - near) * share;
    switch (fit.split) {
      case Split::logarithmic:
        depths.push_back(logarithmic);
        break;
      case Split::practical:
        depths.push_back(fit.split_share * logarithmic + (1 - fit.split_share) * uniform);
        break;
      case Split::pseudo_near:
        depths.push_back(pseudo * std::pow(far / pseudo, share));
        break;
      case Split::uniform:
        depths.push_back(uniform);
        break;
    }
  }
  depths.push_back(far);
  return depths;
}

double lispsm_distance(double near, double far, double sine) {
  return (near + std::sqrt(near * far)) / sine;
}

double tsm_distance(double length, double focus) {
  constexpr double kShare = 0.8;
  if (!(focus < kShare * length)) return std::numeric_limits<double>::infinity();
  return (1 - kShare) * length * focus / (kShare * length - focus);
}

SnappedSpan snapped(double lower, double upper, std::uint32_t size) {
  // A window that begins between two multiples needs one texel more.
  const double least = (upper - lower) / (size - 1.0);
  double texel = std::exp2(std::ceil(4 * std::log2(least)) / 4);
  // The logarithm may have been rounded down.
  while (!(texel >= least)) texel *= std::exp2(0.25);
  return {std::floor(lower / texel) * texel, texel};
}

}  // namespace penumbra::maps
