// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Weight of a light point in V.
enum class PointWeights : std::uint8_t {
  paper,  ///< Schwärzler's equations 5 and 6: 1 / (2^d + 1) on a line, its square on an area
  equal,
  area,  ///< each cell's light, divided among its corners: the trapezoidal rule
};

/// Points of a light at the corners of cells that are split where their maps differ: Schwärzler, "Real-time soft
/// shadows with adaptive light source sampling", sections 3.3.1, 3.3.4 and 3.3.5. Cells of an area are squares of the
/// unit square that split in four, those of a line are intervals that split in two. Points have integer coordinates, so
/// neighbours share their corners. Cells are compared level by level, in one fixed order, so that a limit on points
/// affects all cells alike.
class LightTree {
 public:
  enum class Shape : std::uint8_t { line, area };
  /// Two points whose maps are to be compared; indices into points().
  struct Pair {
    std::uint32_t a = 0, b = 0;
  };
  /// Square (or interval, whose y is the whole height) of the unit square, with the points at its corners.
  struct Cell {
    glm::uvec2 at{0};  ///< lower corner
    std::uint32_t depth = 0;
  };

  /// `levels`: largest number of splits of a cell, at most 12.
  LightTree(Shape shape, std::uint32_t levels);

  /// Returns the points in the order of their addition, in units of 2^-levels.
  [[nodiscard]] const std::vector<glm::uvec2>& points() const { return points_; }
  [[nodiscard]] glm::dvec2 unit(const glm::uvec2& point) const;
  /// Returns the opposite corners of every cell of the deepest level: two pairs for a cell of an area, one for a cell
  /// of a line. Empty if no cell can be split.
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  /// Splits the cells with a pair that differs (`differs`: one for each pair), while the number of points is at most
  /// `most`: a cell whose new points would exceed the limit stays whole, the next may need fewer. Afterwards pairs()
  /// are those of the new cells.
  void split(std::span<const std::uint8_t> differs, std::size_t most);

  /// Returns the cells that were not split, level by level: in the order of depth.
  [[nodiscard]] const std::vector<Cell>& leaves() const { return leaves_; }
  /// Function of a rectangle of the unit square (lower, upper): the amount of light from it.
  using Light = std::function<double(const glm::dvec2&, const glm::dvec2&)>;
  /// Returns the weight of each point; not normalised. The depth d of equations 5 and 6 is that of the deepest cell at
  /// the point: only then do the weights of a completely refined light add up to 1. Where light is uneven, `paper` and
  /// `equal` are multiplied by the mean light of the cells at the point. Callable only if pairs() is empty.
  [[nodiscard]] std::vector<double> weights(PointWeights kind, const Light& light) const;

 private:
  [[nodiscard]] std::vector<glm::uvec2> corners(const Cell& cell) const;
  [[nodiscard]] std::vector<Cell> children(const Cell& cell) const;
  /// Returns the number of points that a cell's children need and that do not exist yet.
  [[nodiscard]] std::size_t new_points(const Cell& cell) const;
  std::uint32_t add(const glm::uvec2& point);
  void find_pairs();

  Shape shape_;
  std::uint32_t levels_;
  std::vector<glm::uvec2> points_;
  std::map<std::uint64_t, std::uint32_t> index_;  // index of the point with these coordinates
  std::vector<Cell> level_, leaves_;              // cells that may be split, and cells that stay whole
  std::vector<Pair> pairs_;
};

}  // namespace penumbra::maps
