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

/// The share of a light that is visible from a view sample, without light samples: rows=exact of edge scatter. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// Of a share of the light: what double must prove it to, so that with the rounding to float V is off by less than a
/// unit in the last place.
constexpr double kProven = 0x1p-26;

/// What of a light's window is the light, in the cells of a grid over it.
struct LightRegion {
  LightWindow window;
  LightMeasure measure;
  std::vector<RowEdge> outline = {};  ///< of a polygon: outside there is one layer more
  double outline_error = 0;           ///< of where its corners are
  bool upper_half = false;  ///< of half a dome: what is below the middle is none of it, and counts one layer more
  double rounding = 1;      ///< a place of the window in the frame's coordinates is off so many times 2⁻⁵³
};
LightRegion make_light_region(const visibility::Light& light, const LightWindow& window, const LightGrid& grid,
                              float scale);

/// Edges as they appear to one view sample, in double, each with the error of where it appears, and the sweep over
/// them: a share with a proof of how far it may be off, or nothing. docs/edge-scatter.md, "Without light samples" and
/// "What double proves".
class RowSum {
 public:
  /// All must outlive it.
  RowSum(const LightGrid& grid, const LightRegion& region, const visibility::SceneFloats& scene, float scale);

  void set_view_sample(const GridSample& at);
  /// Where an edge appears on the light, or in a window of about twice the light what of it does.
  struct Placed {
    RowEdge edge;
    double error = 0;  ///< no end is farther off, along either axis (bound place)
  };
  /// One of the edges that matter to a view sample, again from its stored floats, in double: edges near p appear far
  /// off by what float rounds. Nothing: it changes nothing on the light, or is_open(). `known`: its multiplicity, if
  /// that is sure.
  [[nodiscard]] std::optional<Placed> place(const WideEdges& leaf, std::size_t lane, const CutEnds* ends,
                                            std::optional<int> known = std::nullopt);
  /// For place_side_by_side.
  [[nodiscard]] PlacesFrame frame() const;
  /// All of a table; stops where is_open().
  void add(const CrossingTable& crossing, const ClusterInput& of);
  /// Casters may reach into the sphere that is the light: edges that are added from now on end at the disk that the
  /// view sample (set_view_sample's) sees of it, and each caster that passes through the disk has an edge there. (bound
  /// pass)
  void cut_at_disk(const GridSample& at);
  /// Where one of the casters near the disk passes through it. Nothing: it does not, or is_open().
  [[nodiscard]] std::optional<Placed> place_disk_cut(std::size_t caster);
  /// Rounding hides on which side of an edge the light's corner is.
  [[nodiscard]] bool corner_is_open() const { return corner_is_open_; }
  /// The depth at a place of the light (in cells from its corner) less that at the corner; nothing: an edge is near,
  /// or within `off` of that.
  [[nodiscard]] std::optional<std::int32_t> relative_depth(const glm::dvec2& place, double off = 0) const;
  /// What lies below the carrier's plane counts as one layer more, and what is none of the light. After relative_depth.
  void add_horizon(const HorizonLine& line);
  /// The share that is visible; nothing if it is not proven. `parts`: gets what is visible, if given.
  [[nodiscard]] std::optional<double> visible_share(std::int32_t depth_at_corner, std::vector<Trapezoid>* parts);
  /// Something has not been proven.
  [[nodiscard]] bool is_open() const { return is_open_; }

 private:
  /// A way from p: across and along, and up to the light; what these are off by; and at least how long it is.
  struct Way {
    glm::dvec3 to{0};
    double error = 0, error_up = 0, length = 0;
  };
  struct Ways {
    Way a, b;
    bool b_first = false;    ///< lexicographically
    bool is_unsure = false;  ///< an end is at a sphere's disk within rounding
  };
  void see_cone(const LightCone& cone);
  [[nodiscard]] Way way_to(const glm::dvec3& point) const;
  [[nodiscard]] Way way_to(const CutEnd& end) const;
  [[nodiscard]] Ways ways_of(const WideEdges& leaf, std::size_t lane, const CutEnds* ends) const;
  [[nodiscard]] int multiplicity(const WideEdges& leaf, std::size_t lane) const;
  [[nodiscard]] int side_of(const WideEdges& leaf, std::size_t side, std::size_t lane) const;
  [[nodiscard]] double error_inside(const Way& way, int axis) const;
  [[nodiscard]] bool may_pass_p(const Ways& ways) const;
  [[nodiscard]] bool cut_to_window(Ways& ways);
  [[nodiscard]] double placing_error(double stretch, double error, double error_up, double far) const;
  // At a sphere's disk (rows_at_disk.cpp).
  [[nodiscard]] double error_over_disk(const Way& way) const;
  [[nodiscard]] int side_of_disk(const Way& way) const;
  [[nodiscard]] Way pass_disk(const Way& first, const Way& second) const;
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

  /// Of what is within rounding of a disk, how much more than its error it may be off: side_of_disk takes heights four
  /// times as unsure as they are.
  static constexpr double kUnsure = 8;

  const LightGrid& grid_;
  const LightRegion& region_;
  const visibility::SceneFloats& scene_;
  float scale_;
  std::array<glm::dvec3, 3> axes_;  // as LightGrid::axes; of a sphere or sun the view sample's
  double per_length_, skew_;        // of these: cells a length, and what makes them ill-conditioned
  // Of the view sample: p over the light's plane, and what that is off by.
  glm::dvec3 p_{0};
  std::uint32_t plane_ = 0;
  glm::dvec2 foot_{0};  // from the light's corner, in cells
  double height_ = 0, error_foot_ = 0, error_height_ = 0, steepness_ = 0;

  RowSweep sweep_;
  WidePlaces places_;
  std::vector<RowEdge> edges_;
  std::vector<RowStep> left_;  // of the depth at the light's left side
  double error_ = 0, largest_error_ = 0;
  bool corner_is_open_ = false, is_open_ = false, cuts_at_disk_ = false;
  std::int32_t at_corner_ = 0;  // what add_horizon and add_outline add
};

}  // namespace penumbra::volumes
