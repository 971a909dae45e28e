// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/scatter/vectors/light_measure.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

/// Area of depth zero without light samples: the second half of rows=exact of edge scatter. Inside volumes/ only.
/// docs/edge-scatter.md, "Without light samples".
namespace penumbra::volumes {

/// A projected edge in the light, in cells from its lower left corner, upward: crossing it to the right changes the
/// depth by −k.
struct RowEdge {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::int32_t k = 0;

  friend bool operator<(const RowEdge& a, const RowEdge& b) {
    return std::tie(a.y0, a.x0, a.y1, a.x1, a.k) < std::tie(b.y0, b.x0, b.y1, b.x1, b.k);
  }
};
/// Change of the depth at height y of the light's left side, going up.
struct RowStep {
  double y = 0;
  std::int32_t change = 0;

  friend bool operator<(const RowStep& a, const RowStep& b) {
    return std::tie(a.y, a.change) < std::tie(b.y, b.change);
  }
};

/// Sweeps a row up the light (J. Bentley, T. Ottmann, "Algorithms for reporting and counting geometric intersections",
/// 1979) and keeps the edges that it meets in order. Each gap between neighbours has one depth. A gap's trapezoid ends
/// where one of its sides ends or crosses its neighbour, or where another edge comes in between; events elsewhere on
/// the row cost the gap nothing.
///
/// Rounding: two neighbours are in the right order if they are in order where the first of them ends; if not, they
/// exchange places where they cross, or at once. So any two exchange places at most once, whatever rounding does
/// elsewhere.
class RowSweep {
 public:
  /// `edges` and `steps` are sorted in place; edges lie in the light.
  struct Input {
    double width = 0, height = 0;
    std::span<RowEdge> edges;
    std::span<RowStep> steps;
    std::int32_t depth = 0;                   ///< depth at the light's corner
    std::vector<Trapezoid>* parts = nullptr;  ///< receives the visible parts, if not null
    const LightMeasure* measure = nullptr;    ///< measure of visible parts; null: their area
  };
  struct Area {
    double visible = 0;     ///< measure of depth 0
    double impossible = 0;  ///< measure of negative depths
    std::size_t parts = 0;  ///< parts of depth 0 that were measured individually
    double disorder = 0;  ///< area of gaps whose left side may be right of their right side: depths may be wrong there
    double overlap = 0;   ///< how far, at most, their left sides may be right of their right ones
  };
  Area operator()(const Input& input);

 private:
  struct Line {
    double x = 0, y = 0, slope = 0, end = 0, last_x = 0;
    std::int64_t k = 0;  // 64 bits, so that a line is copied in pieces that loads do not straddle

    [[nodiscard]] double at(double height) const { return x + (height - y) * slope; }
  };
  /// The gap to the left of the line with the same index, from a certain height on.
  struct Gap {
    double since = 0, left = 0, right = 0;  // height where the gap begins, and x of its sides there
    std::int32_t depth = 0;
    bool is_in_order = false;  // its sides were in order when they became neighbours
    bool is_new = false;       // its sides have just become neighbours: neither crossing nor depth is known
  };
  static Line line_of(const RowEdge& edge);
  void sort_edges();
  static constexpr std::size_t kUnknown = ~std::size_t{0};
  [[nodiscard]] double next_row() const;
  void find_first_crossing();
  void find_first_end();
  void end_gap(std::size_t gap, double y);
  void measure_gap(std::size_t gap, double y);
  void begin_gap(std::size_t gap, double y);
  void change_places(std::size_t gap, double y);
  void change_lines(double y);
  [[nodiscard]] bool hand_over(double y);
  void remove(std::size_t line, double y);
  void insert(const RowEdge& edge, double y);
  void renew_gaps(double y);
  void forget(std::size_t gap);

  Input in_;
  Area area_;
  std::vector<Line> lines_;        // in order, between the light's two sides
  std::vector<double> ends_;       // upper ends of the lines; padded by kRoom, like crossings_
  std::vector<Gap> gaps_;          // [0] is unused
  std::vector<double> crossings_;  // heights at which each gap's two sides cross
  std::vector<RowEdge> begin_;
  std::vector<RowEdge> by_bucket_;
  std::vector<std::uint32_t> buckets_;
  std::size_t next_edge_ = 0, next_step_ = 0;
  std::size_t ends_in_order_ = 0;  // gaps of depth > 0 that began in order
  double soonest_end_ = 0;         // lowest end of the lines, and the leftmost that has it
  std::size_t first_end_ = 0;
  double soonest_ = 0;     // lower bound of all crossings
  std::size_t first_ = 0;  // the leftmost gap whose sides cross there; kUnknown if not yet found
};

}  // namespace penumbra::volumes
