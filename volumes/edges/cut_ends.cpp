// SPDX-License-Identifier: Apache-2.0
// Exact places where edges cross a light's plane, in rationals, for areas that rounding to float would affect.

#include "volumes/edges/cut_ends.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

using Rationals = std::array<mpq_class, 3>;

Rationals difference(const glm::dvec3& to, const glm::dvec3& from) {
  Rationals d;
  for (int i = 0; i < 3; ++i) d[static_cast<std::size_t>(i)] = mpq_class(to[i]) - mpq_class(from[i]);
  return d;
}

Rationals cross(const Rationals& a, const Rationals& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

mpq_class dot(const Rationals& a, const Rationals& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

/// For a point x = centre + s u + t v + h n: s = (x − centre) · (v × n) / (n · n), t = (x − centre) · (n × u) / (n ·
/// n).
struct CutEnds::Plane {
  glm::dvec3 center;
  LightWindow window;
  Rationals n, to_s, to_t;
  mpq_class squared;

  explicit Plane(const LightSide& side) : center(side.plane[0]), window(side.window) {
    const Rationals u = difference(side.plane[1], center), v = difference(side.plane[2], center);
    n = cross(u, v);
    to_s = cross(v, n);
    to_t = cross(n, u);
    squared = dot(n, n);
  }

  [[nodiscard]] glm::dvec2 place(const glm::dvec3& a, const glm::dvec3& b) const {
    const Rationals from = difference(a, center), to = difference(b, center);
    mpq_class ha = abs(dot(n, from)), hb = abs(dot(n, to));
    if (ha == 0 && hb == 0) ha = hb = 1;  // a and b are the same point of the plane
    // The crossing is the mean of both ends, each weighted with the other's height.
    const auto mean = [&](const Rationals& along) {
      return mpq_class((dot(along, from) * hb + dot(along, to) * ha) / ((ha + hb) * squared));
    };
    const mpq_class t = mean(to_t), s = mean(to_s) + mpq_class(window.shear) * t;
    const auto share = [&](const mpq_class& at, int axis) {
      const mpq_class low(window.low[axis]), high(window.high[axis]);
      return mpq_class((at - low) / (high - low)).get_d();
    };
    return {share(s, 0), share(t, 1)};
  }
};

CutEnds::CutEnds(const LightSide& side) : side_(side), plane_(std::make_unique<Plane>(side)) {}
CutEnds::~CutEnds() = default;
CutEnds::CutEnds(CutEnds&&) noexcept = default;
CutEnds& CutEnds::operator=(CutEnds&&) noexcept = default;

glm::vec3 CutEnds::rounded(const CutEnd& end) const {
  const glm::dvec2 st = side_.window.frame_place(*end.place);
  return glm::vec3(side_.plane[0] + st.x * (side_.plane[1] - side_.plane[0]) +
                   st.y * (side_.plane[2] - side_.plane[0]));
}

glm::dvec2 CutEnds::in_window(const glm::dvec3& x) const {
  const LightWindow& window = side_.window;
  const glm::dvec3 u = side_.plane[1] - side_.plane[0], v = side_.plane[2] - side_.plane[0], n = glm::cross(u, v);
  const glm::dvec2 at =
      glm::dvec2(glm::dot(glm::cross(v - window.shear * u, n), x), glm::dot(glm::cross(n, u), x)) / glm::dot(n, n);
  return (2.0 * at - (window.high + window.low)) / window.size();
}

std::optional<glm::dvec3> CutEnds::far_crossing(const glm::dvec3& a, const glm::dvec3& b) const {
  const glm::dvec3 u = side_.plane[1] - side_.plane[0], v = side_.plane[2] - side_.plane[0], n = glm::cross(u, v);
  const glm::dvec3 from = a - side_.plane[0], to = b - side_.plane[0];
  const double ha = glm::dot(n, from), hb = glm::dot(n, to), between = std::abs(ha - hb);
  // Error of a determinant of three differences (certain_meeting.cpp), and the resulting uncertainty of the crossing's
  // position.
  const double error = 0x1p-46 * glm::length(u) * glm::length(v) * (glm::length(from) + glm::length(to));
  if (!(between > 16 * error)) return std::nullopt;
  const glm::dvec3 x = from + (ha / (ha - hb)) * (to - from);
  const double moved = 4 * error / between * glm::length(to - from);
  const glm::dvec2 at = in_window(x), size = side_.window.size();
  const double per_length =
      2 * std::max(glm::length(v - side_.window.shear * u) / size.x, glm::length(u) / size.y) / glm::length(n);
  // The crossing is outside of the window by an eighth of its half-size; its uncertainty is at most a quarter of that.
  const bool beside = std::max(std::abs(at.x), std::abs(at.y)) > 1.125;
  return beside && moved * per_length < 1.0 / 32 ? std::optional(side_.plane[0] + x) : std::nullopt;
}

std::uint32_t CutEnds::of_edge(const glm::vec3& a, const glm::vec3& b, bool at_a) {
  const double scale = side_.scale;
  const glm::dvec3 from = stored(a), to = stored(b);
  Edge edge{{from * scale}, {to * scale}};
  CutEnd& end = at_a ? edge.a : edge.b;
  if (const std::optional<glm::dvec3> far = far_crossing(from, to)) {
    end.point = *far * scale;
  } else {
    end.place = plane_->place(from, to);
  }
  edges_.push_back(edge);
  return static_cast<std::uint32_t>(edges_.size());
}

std::uint32_t CutEnds::in_plane(const Crossing& from, const Crossing& to) {
  const auto far = [&](const Crossing& at) {
    return at.a == at.b ? std::optional<glm::dvec3>() : far_crossing(stored(at.a), stored(at.b));
  };
  // If both ends are certainly beyond the same side of the window, so is the edge.
  const std::optional<glm::dvec3> one = far(from), other = far(to);
  if (one && other) {
    const glm::dvec2 a = in_window(*one - side_.plane[0]), b = in_window(*other - side_.plane[0]);
    for (int axis = 0; axis < 2; ++axis) {
      if (std::min(a[axis], b[axis]) > 1.0625 || std::max(a[axis], b[axis]) < -1.0625) return 0;
    }
  }
  const glm::dvec2 a = plane_->place(stored(from.a), stored(from.b)), b = plane_->place(stored(to.a), stored(to.b));
  if (a == b) return 0;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::min(a[axis], b[axis]) > 1 || std::max(a[axis], b[axis]) < 0) return 0;
  }
  edges_.push_back({{glm::dvec3(0), a}, {glm::dvec3(0), b}});
  return static_cast<std::uint32_t>(edges_.size());
}

}  // namespace penumbra::volumes
