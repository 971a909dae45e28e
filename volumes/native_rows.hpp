#pragma once

#include "volumes/native_scatter.hpp"
#include "volumes/row_sweep.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The share of a light that a view sample sees, without light samples: rows=exact of edge scatter. Inside volumes/
/// only.
namespace penumbra::volumes {

/// Edges as they appear to one view sample, in double, and the sweep over them. docs/edge-scatter.md, "Without light
/// samples".
class RowSum {
 public:
  explicit RowSum(const Frame& frame) : frame_(frame) {}

  void clear();
  /// One of the edges that matter to a view sample, again from its stored floats, in double: edges near p appear far
  /// off by what float rounds. False: it passes through p but for rounding.
  [[nodiscard]] bool add(const WideEdges& leaf, std::size_t lane, const Sample& at, Judge& judge);
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
  void add(RowEdge edge);
  [[nodiscard]] static int side_of(const WideEdges& leaf, std::size_t side, std::size_t lane, const Sample& at,
                                   Judge& judge);

  const Frame& frame_;
  RowSweep sweep_;
  std::vector<RowEdge> edges_;
  std::vector<RowStep> left_;  // of the depth at the light's left side
  bool corner_is_open_ = false;
  std::int32_t at_corner_ = 0;  // what add_horizon adds
};

/// The share of the light above the horizon of a view sample, nothing else before it. `above`: Judge::horizon.
float share_above_horizon(const Frame& frame, const glm::dvec3& above);

}  // namespace penumbra::volumes
