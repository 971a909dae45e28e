// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// A block of cells on one face of the cube that a shape may cover, and the range of its depths there.
struct CellBlock {
  std::uint32_t face = 0;
  std::array<std::uint32_t, 2> first{}, last{};  ///< columns and rows, both ends included
  double least = 0, most = 0;                    ///< range of its depths, along the face's axis
};

/// The view samples for which shadow volumes of a point l are counted, in cells of directions from l: a cube of six
/// faces, each of kSide² cells. In a cell, view samples of similar depth form one cluster. All results about places and
/// depths are conservative.
class ReceiverCells {
 public:
  static constexpr std::uint32_t kSide = 96;
  static constexpr std::size_t kCells = std::size_t{6} * kSide * kSide;
  static constexpr std::uint32_t kManyPlanes = 0xfffffffeU;

  struct Cluster {
    glm::dvec3 lower, upper;  ///< box, relative to l
    double depth;             ///< the largest, along the face's axis
    std::uint32_t plane;      ///< SceneFloats::plane of all carriers, or kManyPlanes
  };

  ReceiverCells(const visibility::SceneFloats& scene, const visibility::Light& light, const glm::vec3& l,
                const visibility::ViewSamples& samples);

  [[nodiscard]] std::span<const Cluster> in(std::size_t cell) const {
    return std::span(clusters_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }
  [[nodiscard]] std::size_t size() const { return clusters_.size(); }

  [[nodiscard]] static std::size_t cell_of(std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    return (std::size_t{face} * kSide + y) * kSide + x;
  }

 private:
  std::vector<std::uint32_t> first_;  // kCells + 1
  std::vector<Cluster> clusters_;
};

/// Return the blocks of a convex polygon with corners relative to l, and of a box.
std::vector<CellBlock> blocks_of(std::span<const glm::dvec3> polygon);
std::vector<CellBlock> blocks_of_box(const glm::dvec3& lower, const glm::dvec3& upper);

/// Calls visit(cell) for each cell that the segment a b may appear in.
template <typename Visit>
void for_each_cell_along(const glm::dvec3& a, const glm::dvec3& b, Visit&& visit);

/// Returns conservative ranges of the depths of a plane n · x = d in a cell, no wider than the block's range.
class PlaneDepths {
 public:
  PlaneDepths(const std::array<glm::dvec3, 3>& corners);
  struct Range {
    double least, most;
  };
  [[nodiscard]] Range in(const CellBlock& block, std::uint32_t x, std::uint32_t y) const;
  /// Returns whether a ray through the middle of the cell certainly meets the triangle. All triangles are tested with
  /// the same ray.
  [[nodiscard]] bool covers_middle(std::uint32_t face, std::uint32_t x, std::uint32_t y) const;

 private:
  glm::dvec3 n_;
  double d_;
  std::array<glm::dvec3, 3> planes_;  // each through l and an edge, with a normal toward the triangle
  std::array<double, 3> errors_;
};

/// Returns the vector from l, on a face of the cube: (across, down, 1) for place (x, y) in cells.
glm::dvec3 direction_of(std::uint32_t face, double x, double y);

/// A segment's ends on a face, in cells. segments_of omits faces on which the segment does not appear.
struct CellSegment {
  std::uint32_t face;
  glm::dvec2 from, to;
};
std::vector<CellSegment> segments_of(const glm::dvec3& a, const glm::dvec3& b);

template <typename Visit>
void for_each_cell_along(const glm::dvec3& a, const glm::dvec3& b, Visit&& visit) {
  constexpr double kPad = 1e-6;
  const auto clamped = [](double x) {
    return static_cast<std::uint32_t>(glm::clamp(std::floor(x), 0.0, static_cast<double>(ReceiverCells::kSide - 1)));
  };
  for (const CellSegment& segment : segments_of(a, b)) {
    glm::dvec2 from = segment.from, to = segment.to;
    if (from.y > to.y) std::swap(from, to);
    for (std::uint32_t y = clamped(from.y - kPad); y <= clamped(to.y + kPad); ++y) {
      const double rise = to.y - from.y;
      const auto at = [&](double row) {
        return rise > 0 ? from.x + (to.x - from.x) * glm::clamp((row - from.y) / rise, 0.0, 1.0) : from.x;
      };
      double low = at(y - kPad), high = rise > 0 ? at(y + 1.0 + kPad) : to.x;
      if (low > high) std::swap(low, high);
      for (std::uint32_t x = clamped(low - kPad); x <= clamped(high + kPad); ++x) {
        visit(ReceiverCells::cell_of(segment.face, x, y));
      }
    }
  }
}

}  // namespace penumbra::volumes
