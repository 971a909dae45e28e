#pragma once

#include "volumes/native_scatter.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The share of a light that a view sample sees, without light samples: rows=exact of edge scatter. Inside volumes/
/// only.
namespace penumbra::volumes {

/// A projected edge in the light, in cells from its lower left corner, upward or level: crossing it to the right, the
/// depth changes by −k.
struct RowEdge {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::int32_t k = 0;
};

/// A part of the light between two of its rows: in cells from its lower left corner, x of its two sides at both.
struct Trapezoid {
  struct Row {
    double y = 0, left = 0, right = 0;
  };
  Row low, high;
};

/// Rows of the light put where the outline bends: at ends of edges, at crossings of two, at the light's sides. Between
/// two such rows the visible length of a row is linear in its height, and the row in the middle says it exactly.
/// docs/edge-scatter.md, "Without light samples".
class RowSum {
 public:
  explicit RowSum(const Frame& frame) : frame_(frame) {}

  void clear();
  /// One of the edges that matter to a view sample, again from its stored floats, in double: edges near p appear far
  /// off by what float rounds. False: it passes through p but for rounding.
  [[nodiscard]] bool add(const WideEdges& leaf, std::size_t lane, const Sample& at);
  /// Rounding hides whether an edge passes the light's corner above or below.
  [[nodiscard]] bool corner_is_open() const { return corner_is_open_; }
  /// The depth at a place of the light, in cells from its corner, but for that at the corner; nothing: an edge is near.
  [[nodiscard]] std::optional<std::int32_t> relative_depth(const glm::dvec2& place) const;
  /// What lies below the carrier's plane (Judge::horizon) counts as one layer more.
  void add_horizon(const glm::dvec3& above);
  /// The share that is visible. Less than no layer somewhere that is not within rounding of an edge: nothing.
  /// `parts`: gets what is visible, if given.
  [[nodiscard]] std::optional<double> visible_share(std::int32_t depth_at_corner, std::vector<Trapezoid>* parts);

 private:
  struct Step {
    double y = 0;
    std::int32_t change = 0;
  };
  /// An edge between two rows: x = offset + slope y, up to `end`; its x at the lower row and the upper.
  struct Spanning {
    double offset = 0, slope = 0, end = 0, low = 0, last_x = 0, high = 0;
    std::int32_t k = 0;

    [[nodiscard]] double at(double y) const { return offset + slope * y; }
    [[nodiscard]] double twice_middle() const { return low + high; }
  };
  struct Band {
    double from = 0, to = 0;
    std::int32_t depth = 0;  // at the light's left side
  };
  void add(RowEdge edge);
  void go_on(double from, double to, std::size_t& next);
  [[nodiscard]] double visible_area(const Band& band, int halvings);
  [[nodiscard]] double visible_area_in_order(const Band& band);

  const Frame& frame_;
  std::vector<RowEdge> edges_;
  std::vector<Step> left_;  // of the depth at the light's left side, going up
  std::vector<double> bends_;
  std::vector<Spanning> active_;
  std::vector<Trapezoid>* parts_ = nullptr;
  bool corner_is_open_ = false;
  std::int32_t at_corner_ = 0;  // what add_horizon adds
  double impossible_ = 0;       // area of less than no layer
};

/// The share of the light above the horizon of a view sample, nothing else before it. `above`: Judge::horizon.
float share_above_horizon(const Frame& frame, const glm::dvec3& above);

}  // namespace penumbra::volumes
