// SPDX-License-Identifier: Apache-2.0
// Conservative test whether segments between boxes of view samples and of light samples may meet a triangle's box.

#include "vsm/light_shaft.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::vsm {

// The error of a place is fewer than 8 roundings of twice the reach. The same holds for the interpolated places below
// (s is right to 2⁻⁵², and so is 1 − s; each product and sum rounds once more), times the steepest slope for a sun. A
// light sample is off its plane by `off`, which moves a segment by no more than that. 2⁻⁴⁴ of the sum is ample.
LightShaft::LightShaft(const pairs::LightBox& light, double reach)
    : light_(light),
      margin_(light.sun ? 0x1p-44 * reach * (1 + glm::length(glm::max(glm::abs(light.lower), glm::abs(light.upper)))) +
                              4 * reach * light.off
                        : 0x1p-44 * (reach + glm::length(light.lower) + glm::length(light.upper)) + light.off) {}

bool LightShaft::meets(const PlaceBox& receivers, const PlaceBox& triangle, const glm::dvec2& lower,
                       const glm::dvec2& upper) const {
  if (light_.sun) return sun_meets(receivers, triangle, lower, upper);
  PlaceBox r = receivers, t = triangle;
  if (r.upper.z < 0) {  // behind a two-sided light
    std::swap(r.lower.z, r.upper.z);
    std::swap(t.lower.z, t.upper.z);
    r.lower.z = -r.lower.z, r.upper.z = -r.upper.z, t.lower.z = -t.lower.z, t.upper.z = -t.upper.z;
  }
  if (!(r.lower.z > 0)) return true;
  if (t.upper.z < 0 || t.lower.z > r.upper.z) return false;
  const double from = std::max(t.lower.z, 0.0) / r.upper.z, to = std::min(t.upper.z / r.lower.z, 1.0);
  for (int i = 0; i < 2; ++i) {
    const double least = std::min(lower[i] * (1 - from) + r.lower[i] * from, lower[i] * (1 - to) + r.lower[i] * to),
                 most = std::max(upper[i] * (1 - from) + r.upper[i] * from, upper[i] * (1 - to) + r.upper[i] * to);
    if (t.lower[i] > most + margin_ || t.upper[i] < least - margin_) return false;
  }
  return true;
}

bool LightShaft::sun_meets(const PlaceBox& receivers, const PlaceBox& triangle, const glm::dvec2& lower,
                           const glm::dvec2& upper) const {
  const double from = std::max(receivers.lower.z - triangle.upper.z, 0.0), to = receivers.upper.z - triangle.lower.z;
  if (to < 0) return false;
  for (int i = 0; i < 2; ++i) {
    const double least = receivers.lower[i] + std::min(from * lower[i], to * lower[i]),
                 most = receivers.upper[i] + std::max(from * upper[i], to * upper[i]);
    if (triangle.lower[i] > most + margin_ || triangle.upper[i] < least - margin_) return false;
  }
  return true;
}

}  // namespace penumbra::vsm
