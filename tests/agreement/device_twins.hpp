// SPDX-License-Identifier: Apache-2.0
#pragma once

// Signs that passes on the device compute in floats: the computed number, the exact number and the bound of the
// difference. The computed numbers repeat the device's operations one by one (a driver may sum in another order); exact
// ones are in long double, whose error of 2⁻⁶⁴ is small compared with bounds of 2⁻²⁴ and more. Nothing is scaled,
// because scales are powers of two.

#include "visibility/lights/device_light.hpp"
#include "volumes/edges/plane_normal.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::tests {

using FloatCorners = std::array<glm::vec3, 3>;

/// A number as the device rounds it, its exact value, and the bound of the difference.
struct Rounded {
  float value = 0;
  long double exact = 0, bound = 1;

  /// Returns the share of the bound below which a wrong sign would be trusted: any smaller bound would miss the error.
  /// 0 if the sign is right.
  [[nodiscard]] double wrong() const { return value * exact < 0 ? static_cast<double>(std::abs(value) / bound) : 0; }
  /// Returns wrong(), but at most the share of the bound by which the exact number differs from 0.
  [[nodiscard]] double far_wrong() const { return std::min(wrong(), static_cast<double>(std::abs(exact) / bound)); }
};

constexpr long double kHalfUlp = 0x1p-24L;  // half an ulp of 1: ε in docs/

/// Computes n · (p − a), whose sign is the side of a triangle on which p is. (docs/edge-scatter.md, Side)
inline Rounded side_as_rounded(const FloatCorners& corners, const glm::vec3& p) {
  using Exact = glm::tvec3<long double>;
  const Exact a(corners[0]), normal = glm::cross(Exact(corners[1]) - a, Exact(corners[2]) - a);
  const long double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  if (largest == 0) return {};
  const glm::vec3 n = volumes::rounded_normal(corners), d = p - corners[0];
  return {glm::dot(n, d), std::ldexp(glm::dot(normal, Exact(p) - a), -std::ilogb(largest)),
          8 * kHalfUlp * static_cast<long double>(glm::dot(glm::abs(n), glm::abs(d)))};
}

namespace twins {

template <typename T>
T det(const visibility::DeviceLight& light, const FloatCorners& corners, const glm::vec3& from) {
  using V = glm::tvec3<T>;
  const V u(light.u), v(light.v), p(from), towards = V(light.center) - p, a(corners[0]);
  const V s = glm::cross(v, towards), t = glm::cross(towards, u), w = glm::cross(u, v);
  const auto to_light = [&](const V& d) { return V(glm::dot(s, d), glm::dot(t, d), glm::dot(w, d)); };
  return glm::dot(glm::cross(to_light(a - p), to_light(V(corners[1]) - a)), to_light(V(corners[2]) - a));
}

/// The light's frame, with two cells along a side or twice `half_cells`, and the values that depend on p.
template <typename T>
struct Frame {
  Frame(const visibility::DeviceLight& light, const glm::vec3& from, const glm::vec2& half_cells = glm::vec2(1))
      : p(from) {
    const V u(light.u), v(light.v), n = glm::cross(u, v), center_to_p = p - V(light.center);
    const T squared = glm::dot(n, n);
    axis = glm::normalize(n);
    across = glm::cross(v, n) / squared * T(half_cells.x);
    along = glm::cross(n, u) / squared * T(half_cells.y);
    height = glm::dot(axis, center_to_p);
    foot = V2(glm::dot(across, center_to_p), glm::dot(along, center_to_p)) + V2(half_cells) - T(0.5);
    lean = (V2(T(-0.5)) - foot) / height;
  }

  using V = glm::tvec3<T>;
  using V2 = glm::tvec2<T>;
  V p, axis, across, along;
  T height;
  V2 foot, lean;
};

/// A triangle as seen from p, with the segment to the light's lower left corner as third axis: heights above p, and the
/// products that decide.
template <typename T>
struct AlongSegment {
  AlongSegment(const Frame<T>& frame, const FloatCorners& corners) {
    for (int i = 0; i < 3; ++i) {
      const auto d = glm::tvec3<T>(corners.at(static_cast<std::size_t>(i))) - frame.p;
      const T w = -glm::dot(frame.axis, d);
      height[i] = w;
      x.at(static_cast<std::size_t>(i)) =
          glm::tvec2<T>(glm::dot(frame.across, d), glm::dot(frame.along, d)) - frame.lean * w;
    }
    const auto product = [](const auto& a, const auto& b) { return a.x * b.y - a.y * b.x; };
    f = {product(x[0], x[1]), product(x[1], x[2]), product(x[2], x[0])};
  }

  glm::tvec3<T> height{0};
  std::array<glm::tvec2<T>, 3> x;
  std::array<T, 3> f{};  // products of ab, bc, ca
};

}  // namespace twins

/// Computes det[A, B, C], whose sign is the side of the triangle on which p is. (docs/view-sample.md, bound det)
inline Rounded det_as_rounded(const visibility::DeviceLight& light, const FloatCorners& corners, const glm::vec3& p) {
  const glm::vec3 towards = light.center - p, e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const float size = std::max(glm::length(light.u), glm::length(light.v)),
              r = size * std::max(glm::length(towards), size);
  const float lengths = glm::length(corners[0] - p) * glm::length(e1) * glm::length(e2);
  return {twins::det<float>(light, corners, p), twins::det<long double>(light, corners, p),
          256 * kHalfUlp * static_cast<long double>(r * r * size * size * lengths)};
}

/// The products of ab, bc, ca, whose signs show how the segment from p to the light's lower left corner passes a
/// triangle (docs/edge-scatter.md, Corner), and whether p sees the triangle counter-clockwise (1) or not (−1).
struct CornerProducts {
  std::array<Rounded, 3> f;
  int turn = 0;

  /// Returns the share of the bounds that is needed to notice that by the rounded products the segment passes the
  /// triangle's mirror image; 0 if it does not.
  [[nodiscard]] double wrong() const {
    double least = 1;
    for (const Rounded& x : f) {
      least = std::min(least,
                       x.value * static_cast<float>(turn) < 0 ? static_cast<double>(std::abs(x.value) / x.bound) : 0.0);
    }
    return least;
  }
};

inline CornerProducts corner_products(const visibility::DeviceLight& light, const FloatCorners& corners,
                                      const glm::vec3& p) {
  const twins::Frame<float> frame(light, p);
  const twins::AlongSegment<float> seen(frame, corners);
  const twins::AlongSegment<long double> exact({light, p}, corners);
  const float per_length = std::max(glm::length(frame.across), glm::length(frame.along)),
              lengths = glm::length(p - light.center) / std::abs(frame.height);
  float far = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    far = std::max(far, glm::length(corners.at(i) - p));
    size = std::max(size, std::abs(seen.x.at(i).x) + std::abs(seen.x.at(i).y));
  }
  const float round = 0x1p-24F,
              error_x = round * far * (5 * per_length * (1 + lengths) + (8 + 5 * lengths) * glm::length(frame.lean));
  const float error = (2 * error_x + 4 * round * size) * size + 2 * error_x * error_x;
  CornerProducts products;
  for (std::size_t i = 0; i < 3; ++i) products.f.at(i) = {seen.f.at(i), exact.f.at(i), static_cast<long double>(error)};
  const long double volume = exact.f[1] * exact.height[0] + exact.f[2] * exact.height[1] + exact.f[0] * exact.height[2];
  products.turn = volume > 0 ? 1 : volume < 0 ? -1 : 0;
  return products;
}

}  // namespace penumbra::tests
