// SPDX-License-Identifier: Apache-2.0
// Projects triangles to the light's plane in integer homogeneous coordinates and clips them (Sutherland and Hodgman
// 1974), exactly (back_projection.hpp derives the projection). Not from a paper.

#include "areas/back_projection.hpp"

#include "areas/integer_vector.hpp"
#include "base/assert.hpp"

namespace penumbra::areas {
namespace {

void negate(Integers& a) {
  for (mpz_class& value : a) value = -value;
}

}  // namespace

IntegerFrame integer_frame(const visibility::Light& light, const glm::vec3& p) {
  IntegerFrame frame;
  frame.c = light.center;
  if (!visibility::is_planar(light.kind)) {
    const visibility::LightFrame facing = light_frame_from(light, p);
    frame.endless = light.sun.has_value();
    frame.c = facing.center;
    frame.u_end = facing.u;
    frame.v_end = facing.v;
  } else {
    frame.u_end = light.center_u;
    frame.v_end = light.center_v;
    frame.origin = frame.c;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {frame.c[axis], frame.u_end[axis], frame.v_end[axis]}) frame.grid.include(value);
  }
  return frame;
}

BackProjection::BackProjection(const IntegerFrame& frame, const IntegerGrid& grid, const glm::vec3& p)
    : grid_(grid), p_(grid.integers(p)), c_(grid.integers(frame.c)), endless_(frame.endless) {
  const Integers origin = grid.integers(frame.origin);
  u_ = difference(grid.integers(frame.u_end), origin);
  v_ = difference(grid.integers(frame.v_end), origin);
  const Integers r = difference(endless_ ? Integers{} : p_, c_);
  // det(a, b, d) = (a × b) · d
  to_s_ = cross(v_, r);
  to_t_ = cross(r, u_);
  to_w_ = cross(v_, u_);
  reach_ = -dot(to_w_, r);
  if (reach_ >= 0) return;
  mirrored_ = true;
  reach_ = -reach_;
  for (Integers* coordinate : {&to_s_, &to_t_, &to_w_}) negate(*coordinate);
}

ProjectivePoint BackProjection::project(const glm::vec3& q) const {
  const Integers d = difference(grid_.integers(q), p_);
  return {dot(to_s_, d), dot(to_t_, d), dot(to_w_, d), 1};
}

mpz_class BackProjection::height(ClipPlane plane, const ProjectivePoint& q) const {
  switch (plane) {
    case ClipPlane::light:
      return endless_ ? q.m : reach_ * q.m - q.w;
    case ClipPlane::left:
      return q.s * GridBox::kGrid - box_.s0 * q.w;
    case ClipPlane::right:
      return box_.s1 * q.w - q.s * GridBox::kGrid;
    case ClipPlane::bottom:
      return q.t * GridBox::kGrid - box_.t0 * q.w;
    case ClipPlane::top:
      return box_.t1 * q.w - q.t * GridBox::kGrid;
  }
  PENUMBRA_ASSERT(false, "plane {}", static_cast<int>(plane));
}

ProjectivePoint crossing(const ProjectivePoint& a, const mpz_class& height_a, const ProjectivePoint& b,
                         const mpz_class& height_b) {
  const mpz_class to_a = abs(height_a), to_b = abs(height_b);
  return {a.s * to_b + b.s * to_a, a.t * to_b + b.t * to_a, a.w * to_b + b.w * to_a, a.m * to_b + b.m * to_a};
}

std::optional<ProjectiveEdge> BackProjection::clip_edge(ProjectiveEdge edge, unsigned planes) const {
  auto& [a, b] = edge;
  for (std::size_t i = 0; i < kClipPlanes; ++i) {
    const auto plane = static_cast<ClipPlane>(i);
    if ((planes & bit_of(plane)) == 0) continue;
    const mpz_class at_a = height(plane, a), at_b = height(plane, b);
    if (at_a >= 0 && at_b >= 0) continue;
    if (at_a <= 0 && at_b <= 0) return std::nullopt;  // outside, except possibly an end
    ProjectivePoint cut = crossing(a, at_a, b, at_b);
    (at_a < 0 ? a : b) = std::move(cut);
  }
  return edge;
}

Polygon BackProjection::clip_polygon(const Polygon& polygon, ClipPlane plane,
                                     std::optional<ProjectiveEdge>& cut) const {
  Polygon inside;
  ProjectiveEdge closing;
  bool crossed = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ProjectivePoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const mpz_class at_a = height(plane, a), at_b = height(plane, b);
    if (at_a >= 0) inside.push_back(a);
    if ((at_a >= 0) == (at_b >= 0)) continue;
    crossed = true;
    ProjectivePoint point = crossing(a, at_a, b, at_b);
    inside.push_back(point);
    (at_a >= 0 ? closing.first : closing.second) = std::move(point);
  }
  cut = crossed ? std::optional(std::move(closing)) : std::nullopt;
  return inside;
}

HalfPlane BackProjection::above_plane(const std::array<glm::vec3, 3>& corners, int sign) const {
  const Integers a = grid_.integers(corners[0]);
  Integers normal = cross(difference(grid_.integers(corners[1]), a), difference(grid_.integers(corners[2]), a));
  if (sign < 0) negate(normal);
  return {dot(normal, endless_ ? c_ : difference(c_, a)), dot(normal, u_), dot(normal, v_)};
}

}  // namespace penumbra::areas
