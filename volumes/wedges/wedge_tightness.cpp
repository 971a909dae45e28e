// SPDX-License-Identifier: Apache-2.0
// Measures the area of wedges against the area of the penumbra on receiver planes (wedge_tightness.hpp derives the
// penumbra's cross-section). Not from a paper.

#include "volumes/wedges/wedge_tightness.hpp"

#include "base/parallel.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

constexpr double kReach = 16;  // limit, in extents of the penumbra, beyond which a cross-section counts as unbounded
constexpr std::array kDepths = {0.5, 1.0, 2.0};

/// Returns the part of a polygon where n · q + d ≥ 0.
Polygon clipped(const Polygon& polygon, const glm::dvec2& n, double d) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = glm::dot(n, p) + d, at_q = glm::dot(n, q) + d;
    if (at_p >= 0) part.push_back(p);
    if ((at_p < 0) != (at_q < 0)) part.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return part;
}

/// Plane across the penumbra: origin, two axes, and the normal m.
struct Receiver {
  glm::dvec3 origin, s, t, m;

  [[nodiscard]] glm::dvec2 flat(const glm::dvec3& p) const {
    return {glm::dot(p - origin, s), glm::dot(p - origin, t)};
  }
};

Receiver receiver_beyond(const glm::dvec3& at, const glm::dvec3& m) {
  const glm::dvec3 size = glm::abs(m);
  const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                          : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  const glm::dvec3 s = glm::normalize(glm::cross(axis, m));
  return {at, s, glm::cross(m, s), m};
}

/// Returns nullopt for a penumbra without area; infinity for an unbounded cross-section.
std::optional<double> ratio_on(const Receiver& receiver, const Wedge& wedge, std::span<const glm::dvec3> shape) {
  Polygon images;
  for (const glm::dvec3& x : {wedge.a, wedge.b}) {
    for (const glm::dvec3& l : shape) {
      const double above = glm::dot(receiver.m, x - l), below = glm::dot(receiver.m, receiver.origin - x);
      if (!(above > 0) || !(below > 0)) return std::nullopt;
      images.push_back(receiver.flat(x + below / above * (x - l)));
    }
  }
  const Polygon penumbra = hull_of(images);
  glm::dvec2 low = penumbra[0], high = low;
  for (const glm::dvec2& p : penumbra) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double extent = std::max(high.x - low.x, high.y - low.y), exact = area_of(penumbra);
  if (!(exact > 0x1p-30 * extent * extent)) return std::nullopt;
  const glm::dvec2 middle = 0.5 * (low + high);
  const double reach = kReach * extent;
  Polygon section{middle + glm::dvec2(-reach, -reach), middle + glm::dvec2(reach, -reach),
                  middle + glm::dvec2(reach, reach), middle + glm::dvec2(-reach, reach)};
  for (const Plane& plane : wedge.planes) {
    const glm::dvec3 n = plane.normal();
    section =
        clipped(section, {glm::dot(n, receiver.s), glm::dot(n, receiver.t)}, glm::dot(n, receiver.origin) + plane.d);
  }
  const bool open = std::ranges::any_of(section, [&](const glm::dvec2& p) {
    return std::max(std::abs(p.x - middle.x), std::abs(p.y - middle.y)) > reach * (1 - 0x1p-40);
  });
  return open ? std::numeric_limits<double>::infinity() : area_of(section) / exact;
}

using Ratios = std::array<std::optional<double>, kDepths.size()>;

Ratios ratios_of(const Wedge& wedge, const LightHull& light, std::span<const glm::dvec3> shape) {
  Ratios ratios;
  const auto m =
      wedge.outcome == WedgeOutcome::wedge ? separating_direction({wedge.a, wedge.b, light.corners}) : std::nullopt;
  if (!m) return ratios;
  const bool a_is_farther = glm::dot(*m, wedge.a - wedge.b) > 0;
  const glm::dvec3& farther = a_is_farther ? wedge.a : wedge.b;
  const double before = std::max(glm::dot(*m, farther - light.center), 0.0);
  for (std::size_t i = 0; i < kDepths.size(); ++i) {
    ratios[i] = ratio_on(receiver_beyond(farther + kDepths[i] * before * *m, *m), wedge, shape);
  }
  return ratios;
}

}  // namespace

Tightness tightness_of(std::span<const Wedge> wedges, const LightHull& light, std::span<const glm::dvec3> shape) {
  std::vector<Ratios> ratios(wedges.size());
  for_each_index(wedges.size(), [&](std::size_t i) { ratios[i] = ratios_of(wedges[i], light, shape); });
  Tightness tightness;
  for (std::size_t i = 0; i < wedges.size(); ++i) {
    if (wedges[i].outcome != WedgeOutcome::wedge) continue;
    for (const std::optional<double>& ratio : ratios[i]) {
      if (!ratio) {
        ++tightness.not_measured;
      } else if (std::isinf(*ratio)) {
        ++tightness.unbounded;
      } else {
        tightness.ratios.push_back(*ratio);
      }
    }
  }
  std::ranges::sort(tightness.ratios);
  return tightness;
}

std::optional<double> quantile(std::span<const double> ascending, double share) {
  if (ascending.empty()) return std::nullopt;
  return ascending[static_cast<std::size_t>(std::lround(share * static_cast<double>(ascending.size() - 1)))];
}

}  // namespace penumbra::volumes
