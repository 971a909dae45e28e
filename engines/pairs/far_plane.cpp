// SPDX-License-Identifier: Apache-2.0
// Projection of view samples and triangles onto the far plane of a light's frustum (Sintorn, Eisemann and Assarsson
// 2008, sections 4.1 and 4.2), with error bounds.

#include "engines/pairs/far_plane.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::pairs {
namespace {

/// The footprint of a triangle nearer than this fraction of the far plane's distance is bounded instead of computed.
constexpr double kNear = 0x1p-12;

/// A triangle clipped between two heights: up to five corners.
class Slab {
 public:
  Slab(const std::array<glm::dvec3, 3>& corners, double from, double to)
      : corners_{corners[0], corners[1], corners[2]}, count_(3) {
    cut(1, from);
    cut(-1, to);
  }
  [[nodiscard]] std::span<const glm::dvec3> corners() const { return std::span(corners_).first(count_); }

 private:
  void cut(double sign, double height) {
    std::array<glm::dvec3, 6> kept{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const glm::dvec3 &a = corners_[i], &b = corners_[(i + 1) % count_];
      const double at_a = sign * (a.z - height), at_b = sign * (b.z - height);
      if (at_a >= 0) kept[count++] = a;
      if ((at_a >= 0) == (at_b >= 0)) continue;
      kept[count] = a + (b - a) * (at_a / (at_a - at_b));
      kept[count++].z = height;
    }
    corners_ = kept;
    count_ = count;
  }

  std::array<glm::dvec3, 6> corners_;
  std::size_t count_;
};

}  // namespace

FarPlane::FarPlane(const LightBox& light, double side, double reach, std::span<const std::uint32_t> pixels,
                   std::span<const glm::vec3> p, double per_pixel)
    : light_(light), side_(side) {
  // A place has fewer than 8 roundings of twice the reach, and interpolation in clipping has as many. Light samples are
  // up to `off` from their plane, which moves the point where a segment meets a triangle by no more than that.
  error_ = 0x1p-46 * reach + (light.sun ? 0 : light.off);
  for (const std::uint32_t pixel : pixels) {
    const glm::dvec3 at = place(p[pixel]);
    if (!light.sun && at.z < -16 * error_) continue;
    if (!light.sun && (at.z <= 16 * error_ || std::max(std::abs(at.x), std::abs(at.y)) > kWidest * at.z)) {
      outside_.push_back(pixel);
      continue;
    }
    pixels_.push_back(pixel);
    heights_.push_back(at.z);
  }
  if (pixels_.empty()) return;
  far_ = *std::ranges::max_element(heights_);
  std::vector<glm::dvec2> places;
  double stretch = 1;
  for (const std::uint32_t pixel : pixels_) {
    const glm::dvec3 at = place(p[pixel]);
    places.push_back(light.sun ? glm::dvec2(at) : glm::dvec2(at) * (far_ / at.z));
    if (!light.sun) stretch = std::max(stretch, (1 + kWidest) * far_ / at.z);
  }
  light_pixels_ = LightPixels(places, 4 * error_ * stretch, per_pixel);
}

double FarPlane::nearest(const std::array<glm::vec3, 3>& corners) const {
  return std::min({place(corners[0]).z, place(corners[1]).z, place(corners[2]).z}) - 2 * error_;
}

/// Returns whether the part of a triangle nearer than n = kNear · far certainly projects outside of the window: q = k
/// (x − f l), with k ≥ far / n and f in [0, 1) as in far_plane.hpp. If x is beyond all of the light and its centre in
/// one direction by m > 0, q is beyond m far / n in that direction.
bool FarPlane::misses_window(std::span<const glm::dvec3> polygon) const {
  const double least = 0.99 / kNear;
  for (int i = 0; i < 2; ++i) {
    double from = std::numeric_limits<double>::max(), to = -from;
    for (const glm::dvec3& x : polygon) {
      from = std::min(from, x[i] - 4 * error_);
      to = std::max(to, x[i] + 4 * error_);
    }
    if ((from - light_.upper[i]) * least > std::max(light_pixels_.upper()[i], 0.0) * 1.01) return true;
    if ((light_.lower[i] - to) * least > std::max(-light_pixels_.lower()[i], 0.0) * 1.01) return true;
  }
  return false;
}

void FarPlane::add_upper(Footprint& footprint, std::span<const glm::dvec3> polygon) const {
  for (const glm::dvec3& x : polygon) {
    const double k = light_.sun ? far_ - x.z : far_ / x.z;
    for (const glm::dvec2& l : light_.corners()) {
      const glm::dvec2 direction = light_.sun ? -l : glm::dvec2(x) - l;
      footprint.add(light_.sun ? glm::dvec2(x) + k * direction : l + k * direction);
      // The error of x counts once more for each multiple of x's height in the extrapolation; a sun's slopes are off by
      // `off`.
      const double error = light_.sun ? error_ * (4 + 4 * glm::length(l)) + std::abs(k) * (light_.off + 0x1p-50)
                                      : k * error_ * (4 + 4 * glm::length(direction) / x.z);
      footprint.error = std::max(footprint.error, error);
    }
  }
}

Footprint FarPlane::footprint(const std::array<glm::vec3, 3>& corners) const {
  const std::array at{place(corners[0]), place(corners[1]), place(corners[2])};
  Footprint footprint;
  const double high = std::max({at[0].z, at[1].z, at[2].z}), low = std::min({at[0].z, at[1].z, at[2].z});
  const double all = std::numeric_limits<double>::max();
  if (low > far_ + 4 * error_) return footprint;
  if (light_.sun) {
    add_upper(footprint, Slab(at, -all, far_ + 4 * error_).corners());
    return footprint;
  }
  if (high < -4 * error_) return footprint;
  const double near = kNear * far_;
  footprint.everywhere = !(near > 64 * error_) || (low < near && !misses_window(Slab(at, -4 * error_, near).corners()));
  if (!footprint.everywhere && high >= near) add_upper(footprint, Slab(at, near, far_ + 4 * error_).corners());
  return footprint;
}

}  // namespace penumbra::pairs
