// SPDX-License-Identifier: Apache-2.0
// Left-sample maps (Eisemann and Décoret 2007, section 4.3) with bounds: each texel has the light samples left of all
// of its lines, of any of them, and of its middle line.

#include "vsm/left_samples.hpp"

#include "base/memory.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::vsm {
namespace {

/// Largest error of a line that a texel covers, in radii of the light: a division, a root, an arc tangent and sines are
/// fewer than 2⁸ roundings of numbers up to 8; light samples of a tilted light are floats near its plane.
constexpr double kMargin = 0x1p-18;

}  // namespace

LeftSamples::LeftSamples(const visibility::Light& light, const pairs::LightBox& box, std::uint32_t angles,
                         std::uint32_t distances)
    : center_(0.5 * (box.lower + box.upper)), angles_(angles), distances_(distances), words_(light.words_per_mask()) {
  std::vector<glm::dvec2> places;
  for (const glm::vec3& l : light.points) places.push_back(box.sample(l) - center_);
  for (const glm::dvec2& place : places) radius_ = std::max(radius_, glm::length(place));
  const std::size_t texels = std::size_t{angles} * distances;
  require_memory(3 * (texels + 3) * words_ * sizeof(std::uint32_t),
                 fmt::format("left-sample maps of {} x {} for {} light samples", angles, distances, places.size()),
                 "take a smaller map, or fewer light samples");
  for (auto* map : {&all_, &any_, &middle_}) map->assign((texels + 3) * words_, 0);
  const auto fill = [&](std::size_t number, std::vector<std::uint32_t>& map) {
    for (std::size_t j = 0; j < places.size(); ++j) map[number * words_ + j / 32] |= 1U << j % 32;
  };
  fill(texels, all_), fill(texels, any_), fill(texels, middle_);
  fill(texels + 2, any_);

  const double step = 2 * std::numbers::pi / angles, width = 2 * radius_ / distances;
  tbb::parallel_for(std::uint32_t{0}, angles, [&](std::uint32_t i) {
    const double from = i * step - std::numbers::pi, to = from + step, middle = from + 0.5 * step;
    const auto along = [](double angle, const glm::dvec2& x) { return std::cos(angle) * x.x + std::sin(angle) * x.y; };
    for (std::size_t j = 0; j < places.size(); ++j) {
      const glm::dvec2& x = places[j];
      // Extrema of |x| cos(θ − φ): at the ends, or where θ is φ or φ + π.
      double least = std::min(along(from, x), along(to, x)), most = std::max(along(from, x), along(to, x));
      const double phi = std::atan2(x.y, x.x), at_middle = along(middle, x);
      for (int turn = -2; turn <= 2; ++turn) {
        const double at = phi + turn * std::numbers::pi;
        if (at < from || at > to) continue;
        (turn % 2 == 0 ? most : least) = (turn % 2 == 0 ? 1 : -1) * glm::length(x);
      }
      // A sample is left of the lines of all distances below some value. It is stored at the last of these, and then
      // propagated to the smaller distances.
      const auto put = [&](std::vector<std::uint32_t>& map, const auto& is_left) {
        std::uint32_t end = 0;
        for (std::uint32_t beyond = distances; end < beyond;) {
          const std::uint32_t half = end + (beyond - end) / 2;
          if (is_left(half * width - radius_)) {
            end = half + 1;
          } else {
            beyond = half;
          }
        }
        if (end == 0) return;
        map[(std::size_t{i} * distances + end - 1) * words_ + j / 32] |= 1U << j % 32;
      };
      put(all_, [&](double r) { return least - 4 * kMargin * radius_ > r + width; });
      put(any_, [&](double r) { return most + 4 * kMargin * radius_ > r; });
      put(middle_, [&](double r) { return at_middle >= r + 0.5 * width; });
    }
    for (auto* map : {&all_, &any_, &middle_}) {
      const auto row = std::span(*map).subspan(std::size_t{i} * distances * words_, distances * words_);
      for (std::size_t word = row.size() - words_; word-- > 0;) row[word] |= row[word + words_];
    }
  });
}

LeftSamples::Texel LeftSamples::texel(std::size_t number) const {
  const auto of = [&](const std::vector<std::uint32_t>& map) {
    return std::span(map).subspan(number * words_, words_);
  };
  return {of(all_), of(any_), of(middle_)};
}

LeftSamples::Texel LeftSamples::at(const Line& line) const {
  const std::size_t texels = std::size_t{angles_} * distances_;
  const double size = std::hypot(line.a, line.b), value = line.a * center_.x + line.b * center_.y + line.c;
  // Largest difference between the value at the centre and that at any light sample.
  const double span = size * radius_ * (1 + kMargin) + line.error +
                      kMargin * (std::abs(line.a * center_.x) + std::abs(line.b * center_.y));
  if (value > span) return texel(texels);
  if (value < -span) return texel(texels + 1);
  const double off = line.error + kMargin * (std::abs(line.a * center_.x) + std::abs(line.b * center_.y));
  if (!(off < kMargin * radius_ * size)) return texel(texels + 2);
  const double r = -value / size, angle = std::atan2(line.b, line.a);
  const auto i = static_cast<std::int64_t>(std::floor((angle + std::numbers::pi) / (2 * std::numbers::pi) * angles_));
  const auto k = static_cast<std::int64_t>(std::floor((r + radius_) / (2 * radius_) * distances_));
  return texel(static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, angles_ - 1)) * distances_ +
               static_cast<std::size_t>(std::clamp<std::int64_t>(k, 0, distances_ - 1)));
}

}  // namespace penumbra::vsm
