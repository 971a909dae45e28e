// SPDX-License-Identifier: Apache-2.0
// Evaluates exact areas on blurred surfaces in the order of view samples along a Z curve in space, with 21 bits per
// axis.

#include "session/pictures/lens_areas.hpp"

#include <glm/common.hpp>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace penumbra::session {
namespace {

using visibility::ViewSamples;

/// Spreads 21 bits, with two zeros between neighbouring bits.
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffu;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
  return (bits | bits << 2) & 0x1249249249249249u;
}

}  // namespace

std::vector<std::size_t> LensAreas::answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) {
  const ViewSamples& all = samples();
  const std::size_t first = std::size_t{tile.first_row} * all.width;
  glm::vec3 lower(INFINITY), upper(-INFINITY);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (all.triangle[first + i] == ViewSamples::kBackground) continue;
    open.push_back(i);
    lower = glm::min(lower, all.p[first + i]);
    upper = glm::max(upper, all.p[first + i]);
  }
  // Positions in a cube around all view samples, along a curve in Z order.
  const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
  const double cell = std::max({size.x, size.y, size.z, 0x1p-100}) / ((1 << 21) - 1);
  struct Placed {
    std::uint64_t key;
    std::size_t number;
  };
  std::vector<Placed> placed(open.size());
  tbb::parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
    const glm::dvec3 at = (glm::dvec3(all.p[first + open[i]]) - glm::dvec3(lower)) / cell;
    const auto along = [](double x) { return spread_bits(static_cast<std::uint64_t>(x)); };
    placed[i] = {along(at.x) | along(at.y) << 1 | along(at.z) << 2, open[i]};
  });
  tbb::parallel_sort(
      placed, [](const Placed& a, const Placed& b) { return a.key != b.key ? a.key < b.key : a.number < b.number; });
  std::ranges::transform(placed, open.begin(), &Placed::number);
  return open;
}

}  // namespace penumbra::session
