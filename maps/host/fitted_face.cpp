// SPDX-License-Identifier: Apache-2.0
// Projects directions to fitted faces: homographies, logarithmic rows (Lloyd et al. 2007) and paraboloids (Brabec,
// Annen, Seidel 2002).

#include "maps/host/base_face.hpp"
#include "maps/host/face_fit.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace penumbra::maps {
namespace {

/// Convert b' to rows and back; row_change is the derivative of a row by b'.
double row_of(const FittedFace& face, double b) {
  return face.margin - (1 - 2 * face.margin) * std::log(1 - b * (1 - 1 / face.ratio)) / std::log(face.ratio);
}
double of_row(const FittedFace& face, double row) {
  const double power = (row - face.margin) / (1 - 2 * face.margin);
  return (1 - std::pow(face.ratio, -power)) / (1 - 1 / face.ratio);
}
double row_change(const FittedFace& face, double b) {
  const double share = 1 - 1 / face.ratio;
  return (1 - 2 * face.margin) * share / ((1 - b * share) * std::log(face.ratio));
}

glm::vec3 row(const glm::dmat3& matrix, int i) {
  return {matrix[0][i], matrix[1][i], matrix[2][i]};
}

/// Converts a row that is applied to e into a row that is applied to x − point in world axes.
glm::dvec3 in_world(const glm::dvec3& of_e, int side, const LightBasis& basis) {
  return of_e.x * basis.u + of_e.y * basis.v + of_e.z * (side == 0 ? 1.0 : -1.0) * basis.n;
}

}  // namespace

std::optional<glm::dvec2> FittedFace::place(const glm::dvec3& e) const {
  if (circle) {
    if (!(e.z > 0)) return std::nullopt;
    return 0.5 + (0.5 - margin) * glm::dvec2(e) / (glm::length(e) + e.z);
  }
  const glm::dvec3 at = to_face * e;
  if (!(at.z > 0)) return std::nullopt;
  glm::dvec2 result = glm::dvec2(at) / at.z;
  if (ratio > 0) {
    if (!(result.y < 1 / (1 - 1 / ratio))) return std::nullopt;
    result.y = row_of(*this, result.y);
  }
  const bool inside = std::min(result.x, result.y) >= 0 && std::max(result.x, result.y) < 1;
  return inside ? std::optional(result) : std::nullopt;
}

glm::dvec3 FittedFace::direction(const glm::dvec2& place) const {
  if (circle) {
    const glm::dvec2 at = (place - 0.5) / (0.5 - margin);
    return {2.0 * at / (1 - glm::dot(at, at)), 1};
  }
  const double b = ratio > 0 ? of_row(*this, place.y) : place.y;
  const glm::dvec3 d = glm::inverse(to_face) * glm::dvec3(place.x, b, 1);
  return d / glm::dot(along, d);
}

glm::dvec2 FittedFace::moves(const glm::dvec3& e, const glm::dvec3& by) const {
  if (circle) {
    const double whole = glm::length(e) + e.z, grows = glm::dot(e, by) / glm::length(e) + by.z;
    return (0.5 - margin) / whole * (glm::dvec2(by) - glm::dvec2(e) / whole * grows);
  }
  const glm::dvec3 at = to_face * e, change = to_face * by;
  glm::dvec2 result = (glm::dvec2(change) - glm::dvec2(at) / at.z * change.z) / at.z;
  if (ratio > 0) result.y *= row_change(*this, at.y / at.z);
  return result;
}

gpu::FittedFace FittedFace::rounded() const {
  const glm::dmat3 inverse = glm::inverse(to_face);
  gpu::FittedFace face{};
  face.row_a = row(to_face, 0);
  face.row_b = row(to_face, 1);
  face.row_k = row(to_face, 2);
  face.inverse_a = inverse[0];
  face.inverse_b = inverse[1];
  face.inverse_1 = inverse[2];
  face.along = along;
  face.axis = static_cast<std::uint32_t>(axis);
  face.ratio = circle ? gpu::kCircle : static_cast<float>(ratio);
  face.margin = static_cast<float>(margin);
  face.from = static_cast<float>(from);
  face.to = static_cast<float>(to);
  face.side = static_cast<std::uint32_t>(side);
  return face;
}

gpu::CasterPush face_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                          std::uint32_t size) {
  const glm::dmat3 rows = glm::transpose(face.to_face), inverse = glm::inverse(face.to_face);
  const auto of = [&](const glm::dvec3& x) { return glm::vec3(in_world(x, face.side, basis)); };
  gpu::CasterPush push{};
  push.point = view.point;
  push.near = view.far * kNearOfFar;
  push.far = view.far;
  push.row_x = of(2.0 * rows[0] - rows[2]);
  push.row_y = of(2.0 * rows[1] - rows[2]);
  push.row_w = of(rows[2]);
  push.depth_row = glm::vec3(glm::dot(face.along, inverse[0]) / size, glm::dot(face.along, inverse[1]) / size,
                             glm::dot(face.along, inverse[2]));
  return push;
}

gpu::LogarithmicPush logarithmic_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                                      std::uint32_t size) {
  const glm::dmat3 rows = glm::transpose(face.to_face), inverse = glm::inverse(face.to_face);
  const auto of = [&](const glm::dvec3& x) { return glm::vec3(in_world(x, face.side, basis)); };
  gpu::LogarithmicPush push{};
  push.point = view.point;
  push.far = view.far;
  push.row_a = of(rows[0]);
  push.row_b = of(rows[1]);
  push.row_k = of(rows[2]);
  push.ratio = face.circle ? gpu::kCircle : static_cast<float>(face.ratio);
  push.size = size;
  push.inverse_a = of(inverse[0]);
  push.inverse_b = of(inverse[1]);
  push.inverse_1 = of(inverse[2]);
  push.margin = static_cast<float>(face.margin);
  push.along = of(face.along);
  return push;
}

FittedFace paraboloid_face(int side, std::uint32_t size, std::uint32_t spare) {
  return {.side = side, .margin = static_cast<double>(spare) / size, .circle = true};
}

std::vector<FittedFace> faces_of(const gpu::LightView& view) {
  std::vector<FittedFace> faces;
  for (int s = 0; s < 2; ++s) {
    const gpu::SideView& side = view.side[s];
    for (const BaseFace& base : std::span(kHemicube).first(side.face_count)) {
      PlaceBounds bounds;
      if (side.face_count == 1) {
        bounds.add(glm::dvec2(side.lower));
        bounds.add(glm::dvec2(side.upper));
      } else {
        bounds.add({-1, base.axis == 2 ? -1 : 0});
        bounds.add({1, 1});
      }
      FittedFace face{.side = s, .axis = base.axis, .along = base.along()};
      face.to_face = to_unit(bounds, 0) * base.matrix();
      faces.push_back(face);
    }
  }
  return faces;
}

std::optional<SeenReceiver> seen_receiver(const visibility::ViewSamples& samples, std::size_t pixel,
                                          const LightBasis& basis, bool both_sides, const SceneSpace& space) {
  const glm::dvec3 p(samples.p[pixel]), d = basis.local(p);
  if (d.z == 0 || (d.z < 0 && !both_sides)) return std::nullopt;
  return SeenReceiver{d.z < 0 ? 1 : 0,
                      {d.x, d.y, std::abs(d.z)},
                      glm::dot(samples.camera.forward, space.scene_point(p) - samples.camera.eye)};
}

const FittedFace* face_for(std::span<const FittedFace> faces, const SeenReceiver& receiver) {
  for (const FittedFace& face : faces) {
    if (face.side != receiver.side || receiver.depth < face.from || receiver.depth >= face.to) continue;
    if (face.place(receiver.e)) return &face;
  }
  return nullptr;
}

}  // namespace penumbra::maps
