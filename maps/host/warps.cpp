// SPDX-License-Identifier: Apache-2.0
// Computes the perspectives of Wimmer et al. 2004 (LiSPSM), Martin and Tan 2004 (TSM), Stamminger and Drettakis 2002
// (PSM) and Lloyd et al. 2008 (LogPSM), for a point light, and the perspectives of a frustum's faces: S. Kozlov,
// Perspective shadow maps: care and feeding, GPU Gems 2004; Lloyd, Tuft, Yoon, Manocha, Warping and partitioning for
// low error shadow maps, EGSR 2006. A face's coordinates (a/w, b/w) are the light's post-perspective space, where its
// rays are parallel. There, LiSPSM, TSM and LogPSM apply a perspective along the image of the view axis, whose centre
// is n in front of the nearest visible point. Departure: rays through the light are points of its face, and depths are
// kept as distances along the rays, so that PSM needs no light in post-perspective space and no inversion of depths.

#include "maps/host/warps.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace penumbra::maps {
namespace {

/// Returns the matrix with the rows a, b and k.
glm::dmat3 with_rows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& k) {
  return glm::transpose(glm::dmat3(a, b, k));
}

glm::dvec2 seen_at(const glm::dvec3& x) {
  return glm::dvec2(x) / x.z;
}

/// Returns a perspective along `along`, a unit vector of the face, whose centre is `distance` in front of `nearest`; b'
/// runs from 0 to 1 over `length`.
glm::dmat3 perspective(const glm::dvec2& along, double nearest, double length, double distance) {
  const double far = distance + length;
  const glm::dvec3 a(-along.y, along.x, 0), g(along, 0);
  const glm::dvec3 b = (g - glm::dvec3(0, 0, nearest)) * (far / length), k = g + glm::dvec3(0, 0, distance - nearest);
  return with_rows(a, b, k);
}

/// Returns the sine of the angle γ between the view and the light's ray to the middle of the body.
double sine_of(const SeenBody& body) {
  glm::dvec3 middle(0);
  for (const glm::dvec3& point : body.points) middle += point;
  return glm::length(glm::cross(glm::normalize(middle), glm::normalize(body.forward)));
}

/// Returns the least depth of a point along the view axis, in units of the face's coordinates at that point: divided by
/// the point's distance from the light.
double nearest_depth(const SeenBody& body) {
  const auto depth = [&](const glm::dvec3& point) { return glm::dot(point - body.eye, body.forward); };
  const glm::dvec3 nearest = std::ranges::min(body.points, {}, depth);
  // Taps around receivers may be behind the eye.
  return std::max(depth(nearest), body.near) / nearest.z;
}

/// Returns the distance from the perspective's centre to the nearest visible point; nullopt where a perspective does
/// not apply. The points lie between `near` and `far` from the eye's image.
std::optional<double> distance_of(Fit fit, const SeenBody& body, double near, double far, double focus_at) {
  if (fit == Fit::tsm) return tsm_distance(far - near, focus_at);
  const double sine = sine_of(body);
  if (!(sine > 0)) return std::nullopt;
  if (fit == Fit::logpsm) return near > 0 ? std::optional(near / sine) : std::nullopt;
  // A step across the light's rays changes the depth by the step times the sine.
  const double nearest = nearest_depth(body);
  return lispsm_distance(nearest, nearest + (far - near) * sine, sine);
}

Warp along_the_view(Fit fit, const SeenBody& body, double focus) {
  const glm::dvec3 first = body.eye + body.near * body.forward, last = body.eye + body.far * body.forward;
  if (!(first.z > 0 && last.z > 0 && body.eye.z > 0)) return {};
  const glm::dvec2 axis = seen_at(last) - seen_at(first);
  const double length = glm::length(axis);
  if (!(length > 0)) return {};
  const glm::dvec2 along = axis / length;
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const glm::dvec3& point : body.points) {
    const double at = glm::dot(along, seen_at(point));
    nearest = std::min(nearest, at);
    farthest = std::max(farthest, at);
  }
  if (!(farthest > nearest)) return {};
  const double eye = glm::dot(along, seen_at(body.eye));
  const glm::dvec3 in_focus = body.eye + (body.near + focus * (body.far - body.near)) * body.forward;
  const double focus_at =
      std::clamp(glm::dot(along, seen_at(in_focus)) - nearest, 0.01 * (farthest - nearest), farthest - nearest);
  const auto distance = distance_of(fit, body, nearest - eye, farthest - eye, focus_at);
  // Beyond this distance a perspective is practically affine.
  if (!distance || !(*distance < 1e4 * (farthest - nearest))) return {};
  Warp warp{perspective(along, nearest, farthest - nearest, *distance)};
  if (fit == Fit::logpsm) warp.ratio = (*distance + farthest - nearest) / *distance;
  return warp;
}

/// Perspective of the camera, with depths between near and far mapped from −1 to 1: rows of the image of x − eye, and
/// the constant added to z.
struct CameraMap {
  glm::dvec3 x, y, z, w;
  double z_more = 0;
};

/// Returns the homography from rays from 0 to a plane in post-perspective space, across the light's direction and
/// through the middle of the body there; nullopt if part of the body is on the other side of the line at infinity.
std::optional<glm::dmat3> post_perspective(const SeenBody& body, double back) {
  const glm::dvec3 eye = body.eye - back * body.forward;
  const double near = body.near + back, far = body.far + back;
  if (!(far > near)) return std::nullopt;
  const CameraMap camera{body.across, body.upward, (far + near) / (far - near) * body.forward, body.forward,
                         -2 * far * near / (far - near)};
  const auto image = [&](const glm::dvec3& p) {
    const glm::dvec3 d = p - eye;
    return glm::dvec4(glm::dot(camera.x, d), glm::dot(camera.y, d), glm::dot(camera.z, d) + camera.z_more,
                      glm::dot(camera.w, d));
  };
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const glm::dvec3& point : body.points) {
    const glm::dvec4 at = image(point);
    if (!(at.w > 0)) return std::nullopt;
    lower = glm::min(lower, glm::dvec3(at) / at.w);
    upper = glm::max(upper, glm::dvec3(at) / at.w);
  }
  const glm::dvec3 middle = 0.5 * (lower + upper);
  // The middle of the body in the world, and the image of the middle's ray.
  const double depth = camera.z_more / (middle.z - (far + near) / (far - near));
  const glm::dvec3 c = eye + glm::inverse(with_rows(camera.x, camera.y, camera.w)) *
                                 glm::dvec3(middle.x * depth, middle.y * depth, depth);
  const double w_c = glm::dot(camera.w, c);
  const glm::dvec3 leads =
      glm::dvec3(glm::dot(camera.x, c), glm::dot(camera.y, c), glm::dot(camera.z, c)) - middle * w_c;
  if (!(glm::length(leads) > 0)) return std::nullopt;
  const glm::dvec3 v = glm::normalize(leads);
  // The plane n . p = q in the world.
  const glm::dvec3 n = v.x * camera.x + v.y * camera.y + v.z * camera.z - glm::dot(v, middle) * camera.w;
  const double q = glm::dot(n, eye) - v.z * camera.z_more;
  const auto row = [&](const glm::dvec3& of, double more) { return q * of + (more - glm::dot(of, eye)) * n; };
  const glm::dvec3 x = row(camera.x, 0), y = row(camera.y, 0), z = row(camera.z, camera.z_more), w = row(camera.w, 0);
  const glm::dvec3 up = std::abs(v.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 s = glm::normalize(up - v * glm::dot(up, v)), r = glm::cross(v, s);
  const glm::dmat3 matrix = with_rows(r.x * x + r.y * y + r.z * z, s.x * x + s.y * y + s.z * z, w);
  if (is_moderate(matrix, body.points)) return matrix;
  if (is_moderate(-matrix, body.points)) return -matrix;
  return std::nullopt;
}

Warp perspective_shadow_map(const SeenBody& body) {
  // The eye moves back until all of the body is in front of the eye, seen along the light's rays (Stamminger and
  // Drettakis 2002, section 4.1).
  if (const auto matrix = post_perspective(body, 0)) return {*matrix};
  double back = (body.far - body.near) / 16;
  for (int step = 0; step < 12; ++step, back *= 2) {
    if (const auto matrix = post_perspective(body, back)) return {*matrix};
  }
  return {};
}

/// Returns the face of a frustum whose plane goes through the eye, on the side of `sign` of the picture's axis
/// `across`. Its plane is g · (x − eye) = 0, so a ray e from 0 meets it at eye + W / (g · e), W = (g · eye) e − (g · e)
/// eye.
std::optional<FrustumFace> side_face(const SeenBody& body, const glm::dvec3& across, const glm::dvec3& along,
                                     double sign) {
  const glm::dvec3 g = sign * across - body.forward;
  const double inside = glm::dot(g, body.eye);
  if (!(inside > 0)) return std::nullopt;
  const auto row = [&](const glm::dvec3& of) { return inside * of - glm::dot(of, body.eye) * g; };
  const glm::dvec3 depth = row(body.forward);
  // 1 / depth = (g · e) / depth row, from −1 at the farthest to 1 at the nearest.
  const double least = 1 / body.far, most = 1 / body.near;
  const glm::dvec3 inverse = (2.0 * g - (least + most) * depth) / (most - least);
  return FrustumFace{with_rows(row(along), inverse, depth)};
}

/// Returns the frustum's end at this depth, whose outer side is that of `sign` · forward.
std::optional<FrustumFace> end_face(const SeenBody& body, double at, double sign) {
  const double away = at + glm::dot(body.forward, body.eye);
  if (!(sign * away > 0)) return std::nullopt;
  const auto row = [&](const glm::dvec3& of) { return sign * (away * of - glm::dot(of, body.eye) * body.forward); };
  return FrustumFace{with_rows(row(body.across), row(body.upward), row(body.forward))};
}

}  // namespace

double FrustumFace::beyond(const glm::dvec3& point) const {
  const glm::dvec3 at = matrix * point;
  if (!(at.z > 0)) return std::numeric_limits<double>::infinity();
  return std::max(std::abs(at.x), std::abs(at.y)) / at.z - 1;
}

std::vector<FrustumFace> frustum_faces(const SeenBody& body) {
  std::vector<FrustumFace> faces;
  if (!body.perspective || !(body.far > body.near)) return faces;
  const auto add = [&](const std::optional<FrustumFace>& face) {
    if (face) faces.push_back(*face);
  };
  for (const double sign : {-1.0, 1.0}) {
    add(side_face(body, body.across, body.upward, sign));
    add(side_face(body, body.upward, body.across, sign));
  }
  add(end_face(body, body.near, -1));
  add(end_face(body, body.far, 1));
  return faces;
}

bool is_moderate(const glm::dmat3& matrix, std::span<const glm::dvec3> points) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const glm::dvec3& point : points) {
    const double k = (matrix * point).z / point.z;
    least = std::min(least, k);
    most = std::max(most, k);
  }
  // All points must be on one side of the line at infinity, and far enough from the line for float32.
  constexpr double kStrongest = 1e-4;
  return least > kStrongest * most && most > 0;
}

Warp warp_of(Fit fit, const SeenBody& body, double focus) {
  if (!body.perspective || body.points.empty()) return {};
  return fit == Fit::psm ? perspective_shadow_map(body) : along_the_view(fit, body, focus);
}

}  // namespace penumbra::maps
