#pragma once

// vssm in double, each mean a plain sum over the texels of its window: docs/vssm.md in a few lines. For maps of one
// face.

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
  double exponent = 80, scale = 2, leak = 0, bias = 0.5;
  bool fallback = true;
};

class VssmTwin {
 public:
  struct Box {
    glm::dvec2 lower{0}, upper{0};
    double inside = 1;  ///< the share of the window that is in the map
  };
  struct Answer {
    double v = 1, pcf = 1;     ///< V, and the share of the filter's window that is nearer by no more than rounding
    bool no_blockers = false;  ///< the search says that nothing blocks
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
    const double horizon = share_above_horizon(d, m);
    answer.v = horizon;
    answer.no_blockers = true;
    if (d.z <= nearest_) return answer;
    const double facing = glm::dot(m, d) / d.z, across = std::abs(m.x) + std::abs(m.y);
    const double slope = facing > 0 ? std::min(across / facing, 8.0) : 8.0;
    const bool biased = settings_.moments != "esm";
    const double t =
        normalised(d.z * (1 - (biased ? settings_.bias : 0) * std::max(texel_.x, texel_.y) * (1 + slope))) -
        (biased ? 0 : 0x1p-20);
    const double near = std::min(std::max(nearest_, maps::half_width(stage_->light)), d.z);
    answer.search = box_through(d, near);
    const Lit search = lit(answer.search, t);
    answer.blocker = d.z;
    if (search.share >= 1) return answer;
    answer.no_blockers = false;
    const double low = nearest_ * (1 - kApart), high = std::max(deepest_, nearest_) * (1 + kApart);
    answer.blocker = std::clamp(low + search.blockers * (high - low), nearest_, d.z);
    answer.filter = box_through(d, answer.blocker);
    double v = lit(answer.filter, t).share;
    if (settings_.moments == "csm") v *= settings_.scale;
    v = std::clamp((v - settings_.leak) / (1 - settings_.leak), 0.0, 1.0);
    answer.v = std::min(v, horizon);
    answer.pcf = mean(answer.filter, [&](double q) { return q >= t - 0x1p-18 ? 1.0 : 0.0; });
    return answer;
  }

  /// Heights as the method counts them, 0 … 1.
  [[nodiscard]] double normalised(double height) const {
    const double low = nearest_ * (1 - kApart), high = std::max(deepest_, nearest_) * (1 + kApart);
    return std::clamp((height - low) / (high - low), 0.0, 1.0);
  }

 private:
  static constexpr double kNothing = 1e300, kApart = 1.0 / 1024, kLeastVariance = 0x1p-22;
  struct Lit {
    double share = 1, blockers = 0;
  };

  [[nodiscard]] double share_above_horizon(const glm::dvec3& d, const glm::dvec3& m) const {
    const auto pattern = maps::light_pattern(stage_->light, maps_->basis, 64);
    const auto above = [&](const glm::vec2& s) { return glm::dot(m, d - glm::dvec3(s, 0)) > 0; };
    return static_cast<double>(std::ranges::count_if(pattern, above)) / 64;
  }

  [[nodiscard]] Box box_through(const glm::dvec3& d, double z) const {
    const glm::dvec2 at = (glm::dvec2(d) / d.z - lower_) / texel_,
                     width = 2.0 * half_ * std::max(1 / z - 1 / d.z, 0.0) / texel_;
    const glm::dvec2 own = glm::mix(glm::floor(at) + 0.5, at, glm::min(width, glm::dvec2(1)));
    const glm::dvec2 extent = glm::max(width, glm::dvec2(1)), whole(maps_->size);
    Box box{glm::clamp(own - 0.5 * extent, glm::dvec2(0), whole), glm::clamp(own + 0.5 * extent, glm::dvec2(0), whole),
            1};
    const glm::dvec2 inside = box.upper - box.lower;
    const bool in_map = box.lower == own - 0.5 * extent && box.upper == own + 0.5 * extent;
    box.inside = in_map ? 1 : inside.x * inside.y / (extent.x * extent.y);
    return box;
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

  /// Of all texels that the box touches, or of 16 along an axis; whole ones.
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

  [[nodiscard]] Lit lit(const Box& box, double t) const {
    Lit result;
    if (settings_.moments == "csm") {
      result.share = 0.5;
      result.blockers = 0.5 * mean(box, [](double q) { return q; });
      for (std::uint32_t k = 0; k < settings_.count; ++k) {
        const double c = (2 * k + 1) * std::numbers::pi, step = c * (1 - 0.5 / settings_.count);
        result.share += 2 / c * mean(box, [&](double q) { return std::sin(step * (q - t)); });
        result.blockers -= 2 / c * mean(box, [&](double q) { return q * std::sin(step * (q - t)); });
      }
      result.blockers /= 1 - result.share;
      return result;
    }
    if (settings_.moments == "vsm" || settings_.moments == "lvsm") {
      const double layers = settings_.count, layer = std::min(std::floor(t * layers), layers - 1);
      const auto warped = [&](double q) { return std::clamp(q * layers - layer, 0.0, 1.0); };
      result.share = chebyshev(mean(box, warped), mean(box, [&](double q) { return warped(q) * warped(q); }), warped(t),
                               kLeastVariance * layers * layers);
    } else if (settings_.moments == "evsm") {
      const double c = settings_.exponent / 2, least = kLeastVariance * c * c;
      const auto warped = [&](double way) { return [=](double q) { return way * std::exp(way * c * (q - t)); }; };
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
    result.blockers = (mean(box, [](double q) { return q; }) - result.share * t) / (1 - result.share);
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
