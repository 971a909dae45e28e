// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/light_window.hpp"
#include "volumes/edges/vectors/group.hpp"
#include "volumes/scatter/vectors/light_measure.hpp"
#include "volumes/scatter/vectors/row_sweep.hpp"
#include "volumes/scatter/vectors/wide_places.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Visible fraction of a light for a view sample, without light samples: rows=exact of edge scatter. Inside volumes/
/// only.
namespace penumbra::volumes {

/// Error to which double must prove a fraction of the light, so that with the rounding to float V is off by less than a
/// unit in the last place.
constexpr double kProven = 0x1p-26;

/// The light's part of its window, in the cells of a grid over the window.
struct LightRegion {
  LightWindow window;
  LightMeasure measure;
  std::vector<RowEdge> outline = {};  ///< outline of a polygon: outside there is one more layer
  double outline_error = 0;           ///< error of its corners' places
  bool upper_half = false;  ///< the light is half a dome: the part below the middle is not light, and has one more
                            ///< layer
  double rounding = 1;      ///< error of a place of the window in the frame's coordinates, in units of 2⁻⁵³
};
LightRegion make_light_region(const visibility::Light& light, const LightWindow& window, const LightGrid& grid,
                              float scale);

/// Places edges for one view sample, in double, each with an error bound, and sweeps over them: gives a fraction with a
/// proof of its error, or none. docs/edge-scatter.md, "Without light samples" and "What double proves".
class RowSum {
 public:
  /// All arguments must outlive this object.
  RowSum(const LightGrid& grid, const LightRegion& region, const visibility::SceneFloats& scene, float scale);

  void set_view_sample(const GridSample& at);
  /// Place on the light of an edge, or of its part in a window of about twice the light.
  struct Placed {
    RowEdge edge;
    double error = 0;  ///< upper bound of the ends' errors, along either axis (bound place)
  };
  /// Places an edge again from its stored floats, in double, since float has large errors for edges near p. Returns
  /// nullopt if the edge changes nothing on the light, or on is_open(). `known`: the edge's multiplicity, if that is
  /// certain.
  [[nodiscard]] std::optional<Placed> place(const WideEdges& leaf, std::size_t lane, const CutEnds* ends,
                                            std::optional<int> known = std::nullopt);
  /// Returns the input of place_side_by_side.
  [[nodiscard]] PlacesFrame frame() const;
  /// Adds all edges of a table; stops on is_open().
  void add(const CrossingTable& crossing, const ClusterInput& of);
  /// For casters that may reach into a spherical light: edges added from now on end at the disk that the view sample
  /// (of set_view_sample) sees, and each caster that passes through the disk has an edge there. (bound pass)
  void cut_at_disk(const GridSample& at);
  /// Returns the place where one of the casters near the disk passes through it; nullopt if it does not, or on
  /// is_open().
  [[nodiscard]] std::optional<Placed> place_disk_cut(std::size_t caster);
  /// Returns whether rounding leaves open on which side of an edge the light's corner is.
  [[nodiscard]] bool corner_is_open() const { return corner_is_open_; }
  /// Returns the depth at a place of the light (in cells from its corner) minus that at the corner; nullopt if an edge
  /// is near, or within `off` of the place.
  [[nodiscard]] std::optional<std::int32_t> relative_depth(const glm::dvec2& place, double off = 0) const;
  /// Adds one layer below the carrier's plane, and outside of the light. Call after relative_depth.
  void add_horizon(const HorizonLine& line);
  /// Returns the visible fraction; nullopt if it is not proven. `parts`, if not null, receives the visible parts.
  [[nodiscard]] std::optional<double> visible_share(std::int32_t depth_at_corner, std::vector<Trapezoid>* parts);
  /// Returns a bound of how far any side of the visible parts may be off, in cells. Call after visible_share. (bound
  /// share)
  [[nodiscard]] double side_error() const { return side_error_; }
  /// Returns whether something could not be proven.
  [[nodiscard]] bool is_open() const { return is_open_; }

 private:
  /// A vector from p: its components across, along and up to the light; their errors; and a lower bound of its length.
  struct Direction {
    glm::dvec3 to{0};
    double error = 0, error_up = 0, length = 0;
  };
  struct Directions {
    Direction a, b;
    bool b_first = false;    ///< b is lexicographically first
    bool is_unsure = false;  ///< an end is at a sphere's disk within rounding
  };
  void see_cone(const LightCone& cone);
  [[nodiscard]] Direction direction_to(const glm::dvec3& point) const;
  [[nodiscard]] Direction direction_to(const CutEnd& end) const;
  [[nodiscard]] Directions directions_of(const WideEdges& leaf, std::size_t lane, const CutEnds* ends) const;
  [[nodiscard]] int multiplicity(const WideEdges& leaf, std::size_t lane) const;
  [[nodiscard]] int side_of(const WideEdges& leaf, std::size_t side, std::size_t lane) const;
  [[nodiscard]] double error_inside(const Direction& direction, int axis) const;
  [[nodiscard]] bool may_pass_p(const Directions& directions) const;
  [[nodiscard]] bool cut_to_window(Directions& directions);
  [[nodiscard]] double placing_error(double stretch, double error, double error_up, double far) const;
  // Functions for a sphere's disk (rows_at_disk.cpp).
  [[nodiscard]] double error_over_disk(const Direction& direction) const;
  [[nodiscard]] int side_of_disk(const Direction& direction) const;
  [[nodiscard]] Direction pass_disk(const Direction& first, const Direction& second) const;
  [[nodiscard]] bool is_beside(const RowEdge& edge, double error) const;
  [[nodiscard]] bool passes_by(const RowEdge& edge, double error) const;
  void add_line(const HorizonLine& line);
  void add(RowEdge edge, double error);
  void add(const std::optional<Placed>& placed) {
    if (placed) add(placed->edge, placed->error);
  }
  void add_side_by_side(const PlacesFrame& here, const ClusterInput& of);
  void count_error(double error);
  void keep(const RowEdge& edge);
  void add_outline();

  /// Factor on the error of a vector whose end is within rounding of a disk: side_of_disk uses heights with four times
  /// their error.
  static constexpr double kUnsure = 8;

  const LightGrid& grid_;
  const LightRegion& region_;
  const visibility::SceneFloats& scene_;
  float scale_;
  std::array<glm::dvec3, 3> axes_;  // as LightGrid::axes; for a sphere or sun those of the view sample
  double per_length_, skew_;        // of these axes: cells in a unit of length, and their condition
  // Data of the view sample: p over the light's plane, and its error.
  glm::dvec3 p_{0};
  std::uint32_t plane_ = 0;
  glm::dvec2 foot_{0};  // relative to the light's corner, in cells
  double height_ = 0, error_foot_ = 0, error_height_ = 0, steepness_ = 0;

  RowSweep sweep_;
  WidePlaces places_;
  std::vector<RowEdge> edges_;
  std::vector<RowStep> left_;  // changes of the depth at the light's left side
  double error_ = 0, largest_error_ = 0;
  bool corner_is_open_ = false, is_open_ = false, cuts_at_disk_ = false;
  std::int32_t at_corner_ = 0;  // depth added by add_horizon and add_outline
  double side_error_ = 0;
};

}  // namespace penumbra::volumes
