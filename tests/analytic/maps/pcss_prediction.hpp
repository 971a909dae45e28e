// SPDX-License-Identifier: Apache-2.0
#pragma once

// Predicts pcss's V under casters that are rectangles parallel to the light. The maps are then known in closed form,
// and so is every tap, except those within half a texel of an outline. V lies between the results that these leave
// possible.

#include "maps/host/light_basis.hpp"
#include "maps/products/light_shape.hpp"
#include "tests/analytic/maps/fixture.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::tests {

/// A caster in the light's frame (the light's centre is 0, z the distance from its plane).
struct ParallelCaster {
  double z = 0;
  glm::dvec2 lower{0}, upper{0};
};

struct PcssTaps {
  std::uint32_t blocker = 64, filter = 64;
  glm::dvec2 texel{0};       ///< of the map, in tangents
  double smallest_near = 0;  ///< the radius of a disk of the light's area
};

/// Bounds of V.
struct Between {
  double low = 0, high = 1;
};

class PcssPrediction {
 public:
  /// `casters`: from the nearest to the farthest.
  PcssPrediction(const visibility::Light& light, std::vector<ParallelCaster> casters, const PcssTaps& taps)
      : casters_(std::move(casters)),
        taps_(taps),
        basis_(maps::light_basis(light)),
        search_(maps::light_pattern(light, basis_, taps.blocker)),
        filter_(maps::light_pattern(light, basis_, taps.filter)),
        weights_(weights_of(light)) {}

  /// Predicts V of a receiver on a plane parallel to the light, farther than all casters.
  [[nodiscard]] Between operator()(const glm::dvec3& receiver) const {
    const glm::dvec3 d = basis_.local(receiver);
    const glm::dvec2 at(d.x / d.z, d.y / d.z);
    const double nearest = std::min(d.z, std::max(casters_.front().z, taps_.smallest_near));
    Heights heights;
    for (const glm::vec2& s : search_) heights.add(tap(at + glm::dvec2(s) * (1 / nearest - 1 / d.z)));
    if (!heights.may_be_any()) return {1, 1};
    const auto [low, high] = heights.bounds();
    Between v{0, 0};
    for (std::size_t k = 0; k < filter_.size(); ++k) {
      const glm::dvec2 s(filter_[k]);
      // The tap's position is linear in 1/z: it lies between the positions for the smallest and the largest mean
      // height.
      const glm::dvec2 a = at + s * (1 / low - 1 / d.z), b = at + s * (1 / high - 1 / d.z);
      const Tap between = tap_between(glm::min(a, b), glm::max(a, b));
      if (!between.may_block) v.low += weights_[k];
      if (!between.blocks) v.high += weights_[k];
    }
    if (heights.may_be_none()) v.high = 1;
    return v;
  }

 private:
  /// Returns the weights of the filter's taps, whose sum is 1: equal, or the rectangle's texture at the light points
  /// (first row uppermost).
  [[nodiscard]] std::vector<double> weights_of(const visibility::Light& light) const {
    std::vector<double> weights(filter_.size(), 1.0);
    if (light.texture) {
      const visibility::LightFrame frame = visibility::light_frame(light);
      for (std::size_t k = 0; k < filter_.size(); ++k) {
        const glm::dvec3 point =
            static_cast<double>(filter_[k].x) * basis_.u + static_cast<double>(filter_[k].y) * basis_.v;
        const double s = glm::dot(point, frame.u) / glm::dot(frame.u, frame.u),
                     t = glm::dot(point, frame.v) / glm::dot(frame.v, frame.v);
        const auto x = static_cast<std::size_t>((s + 1) / 2 * light.texture->width),
                   y = static_cast<std::size_t>((1 - t) / 2 * light.texture->height);
        weights[k] = light.texture->luminance[y * light.texture->width + x];
      }
    }
    double sum = 0;
    for (const double weight : weights) sum += weight;
    for (double& weight : weights) weight /= sum;
    return weights;
  }
  struct Tap {
    bool blocks = false, may_block = false;  ///< certainly, possibly
    double low = 0, high = 0;                ///< bounds of the height, if it blocks
  };
  [[nodiscard]] Tap tap(const glm::dvec2& at) const { return tap_between(at, at); }
  /// A tap somewhere in this box of map coordinates, or up to half a texel outside it; corners are snapped to 1/256
  /// texel.
  [[nodiscard]] Tap tap_between(const glm::dvec2& lower, const glm::dvec2& upper) const {
    const glm::dvec2 beside = (0.5 + 1.0 / 256) * taps_.texel;
    Tap result;
    for (const ParallelCaster& caster : casters_) {
      const glm::dvec2 from = caster.lower / caster.z, to = caster.upper / caster.z;
      const bool meets =
          glm::all(glm::greaterThan(upper + beside, from)) && glm::all(glm::lessThan(lower - beside, to));
      if (!meets) continue;
      result.low = result.may_block ? std::min(result.low, caster.z) : caster.z;
      result.high = std::max(result.high, caster.z);
      result.may_block = true;
      const bool inside =
          glm::all(glm::greaterThan(lower - beside, from)) && glm::all(glm::lessThan(upper + beside, to));
      if (!inside) continue;
      result.blocks = true;  // hides all casters behind it
      break;
    }
    return result;
  }

  /// Bounds of the blockers' mean height.
  class Heights {
   public:
    void add(const Tap& tap) {
      if (tap.blocks) {
        low_ += tap.low;
        high_ += tap.high;
        ++sure_;
      } else if (tap.may_block) {
        perhaps_.push_back(tap);
      }
    }
    [[nodiscard]] bool may_be_any() const { return sure_ > 0 || !perhaps_.empty(); }
    [[nodiscard]] bool may_be_none() const { return sure_ == 0; }
    [[nodiscard]] std::pair<double, double> bounds() const {
      std::vector<double> low, high;
      for (const Tap& tap : perhaps_) {
        low.push_back(tap.low);
        high.push_back(-tap.high);
      }
      return {least_mean(low_, sure_, low), -least_mean(-high_, sure_, high)};
    }

   private:
    /// Returns the smallest mean of `count` numbers with this sum and any of the others.
    static double least_mean(double sum, std::size_t count, std::vector<double> others) {
      std::ranges::sort(others);
      for (const double other : others) {
        if (count > 0 && other * static_cast<double>(count) >= sum) break;
        sum += other;
        ++count;
      }
      return sum / static_cast<double>(count);
    }
    double low_ = 0, high_ = 0;
    std::size_t sure_ = 0;
    std::vector<Tap> perhaps_;
  };

  std::vector<ParallelCaster> casters_;
  PcssTaps taps_;
  maps::LightBasis basis_;
  std::vector<glm::vec2> search_, filter_;
  std::vector<double> weights_;
};

}  // namespace penumbra::tests
