// SPDX-License-Identifier: Apache-2.0
#pragma once

// vssm in double, with each mean a plain sum over the texels of its window: docs/vssm.md in a few lines. For maps of
// one face.

#include "maps/products/light_shape.hpp"
#include "maps/products/map_frame.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace penumbra::tests {

struct VssmSettings {
  std::string moments = "vsm";
  std::uint32_t count = 1;  ///< layers of lvsm, terms of csm
  double exponent = 80, scale = 1, leak = 0, bias = 0.5;
  bool fallback = true;
  double offset = 1, damping = 1;
  std::string subdivision = "none";  ///< none, adaptive, uniform
  std::uint32_t cuts = 3, window = 0;
  bool receiver_plane = true, smooth_leak = false;

  [[nodiscard]] std::uint32_t most_cuts() const {
    return subdivision == "none" || moments == "csm" || moments == "esm" ? 0 : cuts;
  }
};

class VssmTwin {
 public:
  struct Box {
    glm::dvec2 lower{0}, upper{0};
    double inside = 1;  ///< the share of the window that is in the map
  };
  struct Answer {
    double v = 1, pcf = 1;     ///< V, and the share of the filter's window not nearer than the receiver (to rounding)
    bool no_blockers = false;  ///< the search found that nothing blocks
    Box search, filter;
    double blocker = 0;  ///< the mean blocker's height
  };

  VssmTwin(const CentreMaps& maps, const Stage& stage, VssmSettings settings)
      : maps_(&maps), stage_(&stage), settings_(std::move(settings)), half_(maps::half_box(stage.light, maps.basis)) {
    const maps::gpu::LightView& view = maps.fitted.views.front();
    for (const float depth : maps.read()) heights_.push_back(depth < 1 ? depth * view.far : kNothing);
    nearest_ = *std::ranges::min_element(heights_);
    for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, i)) continue;
      for (const glm::vec3& corner : stage.floats.corners(i)) {
        deepest_ = std::max(deepest_, maps.basis.local(corner).z);
      }
    }
    for (double& height : heights_) height = height < kNothing ? normalised(height) : 1;
    lower_ = view.side[0].lower;
    texel_ = (glm::dvec2(view.side[0].upper) - lower_) / static_cast<double>(maps.size);
  }

  [[nodiscard]] Answer operator()(std::size_t pixel) const {
    const glm::dvec3 d = maps_->basis.local(glm::dvec3(stage_->samples.p[pixel]));
    const glm::dvec3 n(stage_->samples.n[pixel]);
    const glm::dvec3 m =
        -glm::dvec3(glm::dot(maps_->basis.u, n), glm::dot(maps_->basis.v, n), glm::dot(maps_->basis.n, n));
    Answer answer;
    const double horizon = settings_.window != 0 ? (glm::dot(m, d) > 0 ? 1 : 0) : share_above_horizon(d, m);
    answer.v = horizon;
    answer.no_blockers = true;
    if (d.z <= nearest_) return answer;
    const double facing = glm::dot(m, d) / d.z, across = std::abs(m.x) + std::abs(m.y);
    const double slope = facing > 0 ? std::min(across / facing, 8.0) : 8.0;
    Asking asking{.d = d, .m = m, .kept = 1 - settings_.bias * std::max(texel_.x, texel_.y) * (1 + slope)};
    asking.biased = normalised(d.z * asking.kept);
    asking.exact = asking.biased;
    if (settings_.moments == "esm") asking.exact = normalised(d.z) - 0x1p-20;
    if (settings_.moments == "evsm") {
      asking.exact = normalised(d.z);
      asking.slack = asking.exact - asking.biased;
    }
    answer.filter = window_of_texels(d);
    if (settings_.window == 0) {
      const double near = std::min(std::max(nearest_, maps::half_width(stage_->light)), d.z);
      answer.search = box_through(d, near);
      const Lit search = of_parts(answer.search, asking);
      answer.blocker = d.z;
      if (search.share >= 1 || (settings_.moments == "csm" && settings_.scale * search.share >= 1)) return answer;
      const double low = low_end(), high = high_end();
      answer.blocker = std::clamp(low + search.blocked / (1 - search.share) * (high - low), nearest_, d.z);
      answer.filter = box_through(d, answer.blocker);
    }
    answer.no_blockers = false;
    double v = of_parts(answer.filter, asking).share;
    if (settings_.moments == "csm" && settings_.window != 0) v *= settings_.scale;
    v = std::clamp((v - settings_.leak) / (1 - settings_.leak), 0.0, 1.0);
    if (settings_.smooth_leak) v = v * v * (3 - 2 * v);
    answer.v = std::min(v, horizon);
    answer.pcf = mean(clipped(answer.filter), [&](double q) { return q >= asking.exact - 0x1p-18 ? 1.0 : 0.0; });
    return answer;
  }

  /// Returns a height as the method counts heights, 0 … 1.
  [[nodiscard]] double normalised(double height) const {
    return std::clamp((height - low_end()) / (high_end() - low_end()), 0.0, 1.0);
  }

 private:
  static constexpr double kNothing = 1e300, kLeastVariance = 0x1p-22;
  struct Lit {
    double share = 1, blocked = 0;  ///< the mean height of what is not lit, times its share
  };
  struct Asking {
    glm::dvec3 d, m;
    double kept = 1, biased = 0, exact = 0, slack = 0;  ///< the receiver's height with the bias, and as it is compared
  };

  [[nodiscard]] double low_end() const { return nearest_ * (1 - 1.0 / 1024); }
  [[nodiscard]] double high_end() const { return std::max(deepest_, nearest_); }

  [[nodiscard]] double share_above_horizon(const glm::dvec3& d, const glm::dvec3& m) const {
    const auto pattern = maps::light_pattern(stage_->light, maps_->basis, 64);
    const auto above = [&](const glm::vec2& s) { return glm::dot(m, d - glm::dvec3(s, 0)) > 0; };
    return static_cast<double>(std::ranges::count_if(pattern, above)) / 64;
  }

  /// Windows before they are clipped to the map; clipping sets `inside`.
  [[nodiscard]] Box box_through(const glm::dvec3& d, double z) const {
    const glm::dvec2 at = (glm::dvec2(d) / d.z - lower_) / texel_,
                     width = 2.0 * half_ * std::max(1 / z - 1 / d.z, 0.0) / texel_;
    const glm::dvec2 own = glm::mix(glm::floor(at) + 0.5, at, glm::min(width, glm::dvec2(1)));
    const glm::dvec2 extent = glm::max(width, glm::dvec2(1));
    return {own - 0.5 * extent, own + 0.5 * extent, 1};
  }
  [[nodiscard]] Box window_of_texels(const glm::dvec3& d) const {
    const double side = settings_.window;
    const glm::dvec2 first = glm::floor((glm::dvec2(d) / d.z - lower_) / texel_ - 0.5 * side + 0.5);
    return {first, first + side, 1};
  }
  [[nodiscard]] Box clipped(const Box& window) const {
    const glm::dvec2 whole(maps_->size);
    Box box{glm::clamp(window.lower, glm::dvec2(0), whole), glm::clamp(window.upper, glm::dvec2(0), whole), 1};
    const glm::dvec2 inside = box.upper - box.lower, extent = window.upper - window.lower;
    const bool in_map = box.lower == window.lower && box.upper == window.upper;
    box.inside = in_map ? 1 : inside.x * inside.y / (extent.x * extent.y);
    return box;
  }

  /// Returns the receiver's plane in the direction of a place on the map, less the bias, but no deeper than the
  /// receiver.
  [[nodiscard]] double plane_height(const Asking& asking, const glm::dvec2& place) const {
    const glm::dvec3 direction(lower_ + place * texel_, 1);
    const double facing = glm::dot(asking.m, direction), h = glm::dot(asking.m, asking.d);
    if (!settings_.receiver_plane || h <= 0 || h >= asking.d.z * facing) return asking.biased;
    return normalised(asking.kept * h / facing);
  }

  /// Returns V of the window, or of its parts: parts whose bound is below 1 by that bound, the others by some texels.
  [[nodiscard]] Lit of_parts(const Box& window, const Asking& asking, std::uint32_t cut = 0) const {
    const Box box = clipped(window);
    const glm::dvec2 extent = window.upper - window.lower;
    const bool may_cut = cut < settings_.most_cuts() && std::max(extent.x, extent.y) > 1;
    const bool open = mean(box, [&](double q) { return q >= asking.biased ? 0.0 : 1.0; }) == 0;
    if (settings_.moments != "csm" && settings_.moments != "esm" && open) return {};
    const double t = cut == 0 ? asking.exact : plane_height(asking, 0.5 * (window.lower + window.upper)) + asking.slack;
    if (!may_cut || settings_.subdivision != "uniform") {
      const Lit whole = lit(box, t, asking.slack);
      if (settings_.most_cuts() == 0 || whole.share < 1) return whole;
      if (!may_cut) return at_texels(box, asking);
    }
    Lit sum{0, 0};
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
      const glm::dvec2 lower = window.lower + 0.5 * extent * corner;
      const Lit part = of_parts({lower, lower + 0.5 * extent, 1}, asking, cut + 1);
      sum.share += 0.25 * part.share;
      sum.blocked += 0.25 * part.blocked;
    }
    return sum;
  }

  [[nodiscard]] Lit at_texels(const Box& box, const Asking& asking) const {
    if (box.inside == 0) return {};
    const glm::dvec2 extent = box.upper - box.lower,
                     count = glm::clamp(glm::ceil(extent), glm::dvec2(1), glm::dvec2(4));
    Lit sum{0, 0};
    for (double j = 0; j < count.y; ++j) {
      for (double i = 0; i < count.x; ++i) {
        const glm::dvec2 at = glm::floor(box.lower + (glm::dvec2(i, j) + 0.5) * extent / count);
        const double q = heights_[static_cast<std::size_t>(at.y) * maps_->size + static_cast<std::size_t>(at.x)];
        const bool blocks = q < plane_height(asking, at + 0.5);
        sum.share += blocks ? 0 : 1;
        sum.blocked += blocks ? q : 0;
      }
    }
    const double each = box.inside / (count.x * count.y);
    return {sum.share * each + 1 - box.inside, sum.blocked * each};
  }

  [[nodiscard]] double mean(const Box& box, const std::function<double(double)>& f) const {
    double sum = 0;
    for (auto y = static_cast<std::uint32_t>(box.lower.y); y < box.upper.y; ++y) {
      for (auto x = static_cast<std::uint32_t>(box.lower.x); x < box.upper.x; ++x) {
        const double share = (std::min(x + 1.0, box.upper.x) - std::max(1.0 * x, box.lower.x)) *
                             (std::min(y + 1.0, box.upper.y) - std::max(1.0 * y, box.lower.y));
        sum += share * f(heights_[std::size_t{y} * maps_->size + x]);
      }
    }
    if (box.inside == 0) return f(1);
    const glm::dvec2 extent = box.upper - box.lower;
    return box.inside * sum / (extent.x * extent.y) + (1 - box.inside) * f(1);
  }

  /// Returns the mean over all whole texels that the box touches, at most 16 along an axis.
  [[nodiscard]] double texel_by_texel(const Box& box, const std::function<double(double)>& f) const {
    if (box.inside == 0) return 1;
    const glm::dvec2 first = glm::floor(box.lower), extent = glm::ceil(box.upper) - first,
                     count = glm::min(extent, glm::dvec2(16));
    double sum = 0;
    for (double j = 0; j < count.y; ++j) {
      for (double i = 0; i < count.x; ++i) {
        const glm::uvec2 at(first + (glm::dvec2(i, j) + 0.5) * extent / count);
        sum += f(heights_[std::size_t{at.y} * maps_->size + at.x]);
      }
    }
    return box.inside * sum / (count.x * count.y) + 1 - box.inside;
  }

  [[nodiscard]] static double chebyshev(double mean, double square, double x, double least) {
    const double variance = std::max(square - mean * mean, least);
    return x <= mean ? 1 : variance / (variance + (x - mean) * (x - mean));
  }

  [[nodiscard]] Lit lit(const Box& box, double t, double slack) const {
    Lit result;
    if (settings_.moments == "csm") {
      result.share = 0.5;
      result.blocked = 0.5 * mean(box, [](double q) { return q; });
      const double terms = settings_.count, span = std::max(1 - 0.5 * (1 + settings_.offset) / terms, 0.5);
      for (std::uint32_t k = 0; k < settings_.count; ++k) {
        const double c = (2 * k + 1) * std::numbers::pi;
        const double weight = 2 / c * std::exp(-settings_.damping * std::pow((k + 1) / terms, 2));
        const auto wave = [&](double q) { return std::sin(c * (span * (q - t) + 0.5 * settings_.offset / terms)); };
        result.share += weight * mean(box, wave);
        result.blocked -= weight * mean(box, [&](double q) { return q * wave(q); });
      }
      if (result.share >= 1) result.blocked = 0;
      return result;
    }
    if (settings_.moments == "vsm" || settings_.moments == "lvsm") {
      const double layers = settings_.count, layer = std::min(std::floor(t * layers), layers - 1);
      const auto warped = [&](double q) { return std::clamp(q * layers - layer, 0.0, 1.0); };
      result.share = chebyshev(mean(box, warped), mean(box, [&](double q) { return warped(q) * warped(q); }), warped(t),
                               kLeastVariance * layers * layers);
    } else if (settings_.moments == "evsm") {
      const double c = settings_.exponent / 2, least = std::max(kLeastVariance, slack * slack) * c * c;
      const auto warped = [&](double sign) { return [=](double q) { return sign * std::exp(sign * c * (q - t)); }; };
      const auto bound = [&](const auto& f) {
        return chebyshev(mean(box, f), mean(box, [&](double q) { return f(q) * f(q); }), f(t), least);
      };
      result.share = std::min(bound(warped(1)), bound(warped(-1)));
    } else {
      const auto f = [&](double q) { return std::exp(settings_.exponent * (q - t)); };
      result.share = mean(box, f);
      if (result.share > 1 + 0x1p-10 && settings_.fallback) {
        result.share = texel_by_texel(box, [&](double q) { return std::min(f(q), 1.0); });
      }
      result.share = std::min(result.share, 1.0);
    }
    result.blocked = mean(box, [](double q) { return q; }) - result.share * t;
    return result;
  }

  const CentreMaps* maps_;
  const Stage* stage_;
  VssmSettings settings_;
  glm::dvec2 half_, lower_{0}, texel_{1};
  std::vector<double> heights_;
  double nearest_ = 0, deepest_ = 0;
};

}  // namespace penumbra::tests
