// SPDX-License-Identifier: Apache-2.0
// Footprints of triangles on a plane or height field of view samples (Eisemann and Décoret 2007, section 4.1), with
// error bounds.

#include "vsm/planar_receiver.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::vsm {
namespace {

/// A triangle nearer to the light's lowest corner than this fraction of the distance to the receiver has no box.
constexpr double kGap = 0x1p-12;

}  // namespace

PlanarReceiver::PlanarReceiver(const pairs::LightBox& light, const glm::dvec3& normal, double reach,
                               std::vector<std::uint32_t> pixels, std::span<const glm::vec3> p, double per_texel)
    : normal_(glm::normalize(normal)), sun_(light.sun), pixels_(std::move(pixels)) {
  const glm::dvec3 size = glm::abs(normal_);
  const int least = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  glm::dvec3 beside(0);
  beside[least] = 1;
  across_ = glm::normalize(glm::cross(normal_, beside));
  along_ = glm::cross(normal_, across_);
  // Fewer than 8 roundings of the reach; and light samples may be outside of the corners' hull by `off`.
  error_ = 0x1p-46 * reach + (sun_ ? 0 : light.off);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 l = light.at(light.corners()[i]);
    light_[i] = place(sun_ ? l / glm::length(l) : l);
  }
  const auto by_height = [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; };
  light_low_ = std::ranges::min_element(light_, by_height)->z - 4 * (sun_ ? light.off + 0x1p-40 : error_);
  light_high_ = std::ranges::max_element(light_, by_height)->z + 4 * error_;

  std::vector<glm::dvec2> places;
  lowest_ = std::numeric_limits<double>::max();
  highest_ = -lowest_;
  for (const std::uint32_t pixel : pixels_) {
    const glm::dvec3 at = place(glm::dvec3(p[pixel]));
    places.emplace_back(at);
    depths_.push_back(-at.z);
    lowest_ = std::min(lowest_, at.z);
    highest_ = std::max(highest_, at.z);
  }
  texels_ = pairs::LightPixels(places, error_, per_texel);
}

glm::dvec3 PlanarReceiver::place(const glm::dvec3& x) const {
  return {glm::dot(across_, x), glm::dot(along_, x), glm::dot(normal_, x)};
}

/// Returns −h of the triangle's highest corner: segments from p rise, so the triangle hides only p that are lower.
double PlanarReceiver::nearest(const std::array<glm::vec3, 3>& corners) const {
  double highest = -std::numeric_limits<double>::max();
  // Segments may also fall where a part of the light is below the plane.
  if (!(light_low_ > highest_ + 4 * error_) && !sun_) return highest;
  if (sun_ && !(light_low_ > 0)) return highest;
  for (const glm::vec3& corner : corners) highest = std::max(highest, place(glm::dvec3(corner)).z);
  return -highest - 4 * error_;
}

pairs::Footprint PlanarReceiver::footprint(const std::array<glm::vec3, 3>& corners) const {
  pairs::Footprint footprint;
  std::array<glm::dvec3, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) at[i] = place(glm::dvec3(corners[i]));
  const double high = std::max({at[0].z, at[1].z, at[2].z}), bottom = lowest_ - 4 * error_;
  // If all of the light is above the view samples, a triangle below all view samples, or above the light, hides
  // nothing.
  const double gap = sun_ ? 0x1p-10 : kGap * (light_low_ - lowest_);
  const bool light_above = sun_ ? light_low_ > gap : light_low_ > highest_ + 4 * error_ && gap > 64 * error_;
  if (light_above && high < bottom) return footprint;
  if (light_above && !sun_ && std::min({at[0].z, at[1].z, at[2].z}) > light_high_) return footprint;
  footprint.everywhere = !light_above || (!sun_ && high > light_low_ - gap);
  if (footprint.everywhere) return footprint;

  // Clips the triangle to the part above `bottom`: up to four corners.
  std::array<glm::dvec3, 6> part{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = at[i], &b = at[(i + 1) % 3];
    if (a.z >= bottom) part[count++] = a;
    if ((a.z >= bottom) != (b.z >= bottom)) part[count++] = a + (b - a) * ((bottom - a.z) / (b.z - a.z));
  }
  glm::dvec2 lower(std::numeric_limits<double>::max()), upper(-lower);
  for (const glm::dvec3& x : std::span(part).first(count)) {
    for (const glm::dvec3& l : light_) {
      const glm::dvec2 direction = sun_ ? -glm::dvec2(l) : glm::dvec2(x) - glm::dvec2(l);
      const double rise = sun_ ? l.z : l.z - x.z;
      for (const double h : {lowest_, highest_}) {
        const double k = (sun_ ? x.z - h : l.z - h) / rise;
        const glm::dvec2 q = (sun_ ? glm::dvec2(x) : glm::dvec2(l)) + k * direction;
        lower = glm::min(lower, q);
        upper = glm::max(upper, q);
        // Errors of x and l, multiplied as the extrapolation multiplies their differences; for a sun also the error of
        // its direction.
        footprint.error =
            std::max(footprint.error, 8 * error_ * (1 + std::abs(k)) * (1 + glm::length(direction) / rise));
        if (sun_) footprint.error += 0x1p-40 * std::abs(k);
      }
    }
  }
  if (count == 0) return footprint;
  footprint.add(lower);
  footprint.add({upper.x, lower.y});
  footprint.add(upper);
  footprint.add({lower.x, upper.y});
  return footprint;
}

}  // namespace penumbra::vsm
