// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

// Part of a region that no polygon covers, by a sweep over slabs. Internal to areas/.

namespace penumbra::areas {

/// Edge of a polygon that runs counter-clockwise. A vertical line that crosses the edge upward counts +1 if the edge
/// runs toward larger s (the polygon is above the edge), −1 if it runs back.
template <typename Number>
struct SweepEdge {
  Number s0, t0, s1, t1;  ///< s0 < s1
  int cover = 0;          ///< added to the depth of the covering polygons
  int region = 0;         ///< added to the depth of the region itself
};

/// Edge of a sweep at a slab: its height at the two ends of the strip, and in the slab's middle and at its ends.
template <typename Number>
struct ActiveEdge {
  const SweepEdge<Number>* edge;
  Number left, right;  ///< t at the strip's two ends
  Number t;            ///< in the middle of the slab
  Number from, to;     ///< t at the slab's two ends; set only if the measure needs them
};

/// Measures plain area. A measure defines: the contribution between two edges that do not cross within a slab, as the
/// mean over the slab of the contribution to a vertical line; the positions at which further strips begin; and the
/// current strip and slab.
template <typename Number>
struct PlainMeasure {
  static constexpr bool kNeedsEnds = false;
  void add_breaks(std::vector<Number>& /*breaks*/) const {}
  void enter_strip(const Number& /*middle*/) {}
  void enter_slab(const Number& /*from*/, const Number& /*to*/) {}
  [[nodiscard]] Number between(const ActiveEdge<Number>& low, const ActiveEdge<Number>& high) const {
    return high.t - low.t;
  }
};

/// Computes the area (or the quantity of Measure) of {region > 0 and cover ≤ 0}, where both counts start from 0 at t =
/// −∞ and step at each edge. Edges may cross, touch, coincide and run along one another.
///
/// Between neighbouring end points (a strip) the same edges are active. Within a strip, between neighbouring crossings
/// (a slab), the edges keep their order, and the uncovered length of a vertical line is linear in s: its value in the
/// middle times the width is the slab's area. With rational numbers the result is exact. With double it is the exact
/// result for end points and crossings moved by rounding: docs/exact.md has the bound. The result does not depend on
/// the order of the edges.
template <typename Number, typename Measure = PlainMeasure<Number>>
class AreaSweep {
 public:
  explicit AreaSweep(Measure measure = {}) : measure_(std::move(measure)) {}

  Number uncovered_area(std::vector<SweepEdge<Number>>& edges) {
    std::sort(edges.begin(), edges.end(), before);
    breaks_.clear();
    for (const SweepEdge<Number>& edge : edges) {
      breaks_.push_back(edge.s0);
      breaks_.push_back(edge.s1);
    }
    measure_.add_breaks(breaks_);
    sort_unique(breaks_);
    active_.clear();
    std::size_t next = 0;
    Number area = 0;
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
      const Number &left = breaks_[i], &right = breaks_[i + 1];
      std::erase_if(active_, [&](const Active& active) { return active.edge->s1 <= left; });
      for (; next < edges.size() && edges[next].s0 <= left; ++next) active_.push_back({&edges[next], 0, 0, 0, 0, 0});
      area += strip(left, right);
    }
    return area;
  }

 private:
  using Active = ActiveEdge<Number>;

  static bool before(const SweepEdge<Number>& a, const SweepEdge<Number>& b) {
    if (a.s0 != b.s0) return a.s0 < b.s0;
    if (a.t0 != b.t0) return a.t0 < b.t0;
    if (a.s1 != b.s1) return a.s1 < b.s1;
    if (a.t1 != b.t1) return a.t1 < b.t1;
    return a.cover != b.cover ? a.cover < b.cover : a.region < b.region;
  }

  static void sort_unique(std::vector<Number>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }

  /// Returns the edge's height at s, never outside the edge's own end points, for any rounding.
  static Number height(const SweepEdge<Number>& edge, const Number& s) {
    if (s <= edge.s0) return edge.t0;
    if (s >= edge.s1) return edge.t1;
    const Number share = (s - edge.s0) / (edge.s1 - edge.s0);
    const Number t = edge.t0 + share * (edge.t1 - edge.t0);
    return std::clamp(t, std::min(edge.t0, edge.t1), std::max(edge.t0, edge.t1));
  }

  Number strip(const Number& left, const Number& right) {
    if (active_.size() < 2) return 0;
    for (Active& active : active_) {
      active.left = height(*active.edge, left);
      active.right = height(*active.edge, right);
      active.t = (active.left + active.right) / 2;
    }
    const Number width = right - left;
    measure_.enter_strip((left + right) / 2);
    sort_active();
    if (!some_cross()) {
      set_ends(0, 1);
      measure_.enter_slab(left, right);
      return width * uncovered_length();
    }

    crossings_.assign({left, right});
    for (std::size_t i = 0; i < active_.size(); ++i) {
      for (std::size_t j = i + 1; j < active_.size(); ++j) add_crossing(active_[i], active_[j], left, width);
    }
    sort_unique(crossings_);
    Number area = 0;
    for (std::size_t i = 0; i + 1 < crossings_.size(); ++i) {
      const Number middle = (crossings_[i] + crossings_[i + 1]) / 2;
      const Number share = (middle - left) / width;
      for (Active& active : active_) active.t = active.left + share * (active.right - active.left);
      sort_active();
      set_ends((crossings_[i] - left) / width, (crossings_[i + 1] - left) / width);
      measure_.enter_slab(crossings_[i], crossings_[i + 1]);
      area += (crossings_[i + 1] - crossings_[i]) * uncovered_length();
    }
    return area;
  }

  /// Computes the edges' heights at the ends of a slab, given as fractions of the strip.
  void set_ends(const Number& from, const Number& to) {
    if constexpr (Measure::kNeedsEnds) {
      for (Active& active : active_) {
        active.from = active.left + from * (active.right - active.left);
        active.to = active.left + to * (active.right - active.left);
      }
    }
  }

  /// Sorts by insertion, since the order hardly changes from slab to slab.
  void sort_active() {
    for (std::size_t i = 1; i < active_.size(); ++i) {
      for (std::size_t j = i; j > 0 && active_[j].t < active_[j - 1].t; --j) std::swap(active_[j], active_[j - 1]);
    }
  }

  /// Returns whether some edges cross within the slab. Edges that do not, once sorted by their middles, are also sorted
  /// at both ends.
  [[nodiscard]] bool some_cross() const {
    for (std::size_t i = 1; i < active_.size(); ++i) {
      if (active_[i].left < active_[i - 1].left || active_[i].right < active_[i - 1].right) return true;
    }
    return false;
  }

  void add_crossing(const Active& a, const Active& b, const Number& left, const Number& width) {
    const Number at_left = b.left - a.left, at_right = b.right - a.right;
    const bool cross = (at_left < 0 && at_right > 0) || (at_left > 0 && at_right < 0);
    if (!cross) return;
    const Number s = left + width * (at_left / (at_left - at_right));
    crossings_.push_back(std::clamp(s, left, crossings_[1]));
  }

  [[nodiscard]] Number uncovered_length() const {
    Number length = 0;
    int cover = 0, region = 0;
    for (std::size_t i = 0; i + 1 < active_.size(); ++i) {
      cover += active_[i].edge->cover;
      region += active_[i].edge->region;
      if (region > 0 && cover <= 0) length += measure_.between(active_[i], active_[i + 1]);
    }
    return length;
  }

  Measure measure_;
  std::vector<Number> breaks_, crossings_;  // of a strip: its left and right end, then the values between
  std::vector<Active> active_;
};

}  // namespace penumbra::areas
