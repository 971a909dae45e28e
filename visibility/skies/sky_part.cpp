// SPDX-License-Identifier: Apache-2.0
// Sums flux over trapezoids of a sweep, by their sides.

#include "visibility/skies/sky_part.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <tuple>

namespace penumbra::visibility {

SkyPart::SkyPart(const Light& face) : sky_(*face.dome->sky), face_(static_cast<std::size_t>(face.dome->face)) {
  PENUMBRA_ASSERT(face.dome->face >= 0, "light {} is no face", face.name);
}

void SkyPart::add(const std::array<glm::dvec2, 4>& corners, Level level) {
  const int fixed = level == Level::s ? 0 : 1, free = 1 - fixed;
  std::vector<End>& ends = level == Level::s ? along_t_ : along_s_;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    if ((i + (level == Level::s ? 1 : 0)) % 2 != 0) {
      flux_ += sky_.side(face_, from, to, exposure_);
      continue;
    }
    ends.push_back({from[fixed], from[free], 1});
    ends.push_back({to[fixed], to[free], -1});
  }
}

void SkyPart::add_above(const glm::dvec3& n) {
  flux_ += sky_.of_face_above(face_, n);
}

/// Adds the sides that did not cancel. Ends that should be equal may differ by rounding: the side between them is
/// shorter than kShortest, and changes the flux by less than that times the picture's light.
void SkyPart::add_levels(std::vector<End>& ends, Level level) {
  constexpr double kShortest = 0x1p-46;
  std::ranges::sort(ends, {}, [](const End& end) { return std::tie(end.level, end.at, end.change); });
  int count = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    count += ends[i].change;
    const auto& [at, from, change] = ends[i];
    const double to = ends[i + 1].at;
    if (count == 0 || ends[i + 1].level != at || to - from <= kShortest) continue;
    const glm::dvec2 a = level == Level::s ? glm::dvec2(at, from) : glm::dvec2(from, at),
                     b = level == Level::s ? glm::dvec2(at, to) : glm::dvec2(to, at);
    flux_ += static_cast<double>(count) * sky_.side(face_, a, b, exposure_);
  }
  ends.clear();
}

glm::dvec3 SkyPart::take_form_factor(const glm::dvec3& n) {
  add_levels(along_t_, Level::s);
  add_levels(along_s_, Level::t);
  const glm::dvec3 sum = sky_.form_factor(flux_, n);
  flux_ = SkyFlux(0.0);
  return sum;
}

}  // namespace penumbra::visibility
