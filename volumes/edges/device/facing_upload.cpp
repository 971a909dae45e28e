// SPDX-License-Identifier: Apache-2.0
// The host's half of the facing filter: normals in double, rounded once, and error bounds of them and of the device's
// arithmetic. A change of an expression here or in silhouette_facing.comp requires a change of its derivation in
// volumes/README.md (Bounds).

#include "volumes/edges/device/facing_upload.hpp"

#include "mesh/predicates.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::volumes {
namespace {

constexpr double kRound = 0x1p-24;        // of float32
constexpr double kRoundDouble = 0x1p-53;  // of double
constexpr double kLeastNormal = 0x1p-40;  // a smaller coordinate of a normal is taken as 0, and the slack accounts for
                                          // that
constexpr int kGrid = 80;                 // coarse: scaled coordinates are multiples of 2⁻⁸⁰
constexpr float kUnderflow = 0x1p-120F;   // (bound underflow)
constexpr float kFar = 0x1p60F;           // points farther away than this many scene sizes are left to the host
constexpr float kAlwaysUndecided = 0x1p100F;
constexpr gpu::FacingTriangle kNoArea = {{0, 0, 0}, {0, 0, 0}, {-1, -1, -1}};

bool on_grid(double scaled) {
  const double units = std::ldexp(scaled, kGrid);
  return units == std::rint(units);
}

double largest_of(const std::array<double, 3>& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

struct Normal {
  std::array<double, 3> n{}, error{};
};

/// Returns (b − a) × (c − a), and the error of each coordinate (bound normal).
Normal normal_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 e1 = glm::dvec3(b) - glm::dvec3(a), e2 = glm::dvec3(c) - glm::dvec3(a);
  Normal normal;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double plus = e1[j] * e2[k], minus = e1[k] * e2[j];
    normal.n[static_cast<std::size_t>(i)] = plus - minus;
    normal.error[static_cast<std::size_t>(i)] = 8 * kRoundDouble * (std::abs(plus) + std::abs(minus));
  }
  return normal;
}

/// Returns the error of n · g in this coordinate for each unit of |g| (bound slack). Rounded up, with a margin.
double slack_of(double n, double error) {
  if (n == 0 && error == 0) return 0;
  const double slack = std::max(16 * kRound * std::abs(n) + 2 * error, kLeastNormal);
  return std::abs(n) < kLeastNormal ? slack + std::abs(n) : slack;
}

}  // namespace

FacingUpload::FacingUpload(std::span<const glm::vec3> positions) : positions_(positions) {
  float largest = 0;
  for (const glm::vec3& p : positions) {
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis]));
  }
  if (largest > 0) exponent_ = -std::ilogb(largest);
  coarse_ = std::ranges::all_of(positions, [&](const glm::vec3& p) {
    return on_grid(std::ldexp(double{p.x}, exponent_)) && on_grid(std::ldexp(double{p.y}, exponent_)) &&
           on_grid(std::ldexp(double{p.z}, exponent_));
  });
}

std::vector<gpu::FacingTriangle> FacingUpload::triangles(std::span<const mesh::Triangle> triangles) const {
  std::vector<gpu::FacingTriangle> result((triangles.size() + 31) / 32 * 32, kNoArea);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 1024), [&](const auto& range) {
    for (std::size_t t = range.begin(); t < range.end(); ++t) {
      const auto [i, j, k] = triangles[t];
      const glm::vec3 &a = positions_[i], &b = positions_[j], &c = positions_[k];
      if (mesh::collinear(a, b, c)) continue;
      const Normal normal = normal_of(a, b, c);
      const int scale = -std::ilogb(std::max(largest_of(normal.n), largest_of(normal.error)));
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        const double n = std::ldexp(normal.n[at], scale), error = std::ldexp(normal.error[at], scale);
        result[t].a[axis] = static_cast<float>(std::ldexp(double{a[axis]}, exponent_));
        result[t].n[axis] = std::abs(n) < kLeastNormal ? 0.0F : static_cast<float>(n);
        result[t].slack[axis] = static_cast<float>(slack_of(n, error));
      }
    }
  });
  return result;
}

std::vector<gpu::FacingPoint> FacingUpload::points(std::span<const glm::vec3> points) const {
  std::vector<gpu::FacingPoint> result;
  result.reserve(points.size());
  for (const glm::vec3& p : points) {
    gpu::FacingPoint point{{0, 0, 0}, coarse_ ? 0.0F : kUnderflow};
    for (int axis = 0; axis < 3; ++axis) {
      const double scaled = std::ldexp(double{p[axis]}, exponent_);
      if (std::abs(scaled) > kFar) {
        point = {{0, 0, 0}, kAlwaysUndecided};
        break;
      }
      if (!on_grid(scaled)) point.slack = kUnderflow;
      point.p[axis] = static_cast<float>(scaled);
    }
    result.push_back(point);
  }
  return result;
}

}  // namespace penumbra::volumes
