// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/find.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/lights/device_light.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// View-sample mapping on a processor: data passed between its stages. Inside vsm/ only.
namespace penumbra::vsm {

// Names from engines/vectors/ that this data is made of.
using vectors::Cluster;
using vectors::ClusterSample;
using vectors::GridSample;
using vectors::Hull;
using vectors::kRound;
using vectors::kWide;
using vectors::LightGrid;
using vectors::LightTiles;
using vectors::Open;
using vectors::OpenJudge;
using vectors::SampleMask;
using vectors::Table;
using vectors::TriangleTable;
using vectors::WidePoints;
using vectors::WideTriangles;
using vectors::WideTriangleTree;
using enum vectors::TriangleField;

/// Columns for a triangle that may appear at a light row: places of its corners, their error, and its row in the
/// group's table (bits).
enum SurvivorField : std::size_t { kX0, kY0, kX1, kY1, kX2, kY2, kError, kTriangle, kSurvivorFields };
using SurvivorTable = Table<kSurvivorFields>;

struct PairInput {
  const LightGrid& grid;
  const visibility::Light& light;
  const visibility::DeviceLight& device_light;
  float scale;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const ClusterSample> samples;
  const TriangleTable& triangles;
  std::span<const glm::vec3> p;  ///< the picture's view samples, as stored
};

/// Light samples hidden from one view sample: rows of columns.
class Blocked {
 public:
  void reset(std::uint32_t rows, std::uint32_t columns);
  [[nodiscard]] std::size_t words_per_row() const { return words_per_row_; }
  [[nodiscard]] std::uint64_t* row(std::uint32_t row) { return bits_.data() + row * words_per_row_; }
  [[nodiscard]] bool test(std::uint32_t row, std::uint32_t column) {
    return (this->row(row)[column / 64] >> column % 64 & 1) != 0;
  }
  /// Blocks columns `from` … `to` of a row; from ≤ to.
  void add(std::uint32_t row, std::uint32_t from, std::uint32_t to) {
    std::uint64_t* const words = this->row(row);
    for (std::uint32_t word = from / 64; word <= to / 64; ++word) {
      const std::uint32_t first = word == from / 64 ? from % 64 : 0, last = word == to / 64 ? to % 64 : 63;
      words[word] |= ~std::uint64_t{0} << first & ~std::uint64_t{0} >> (63 - last);
    }
  }
  [[nodiscard]] std::uint32_t count() const;

 private:
  std::vector<std::uint64_t> bits_;
  std::size_t words_per_row_ = 1;
};

/// Buffers of one thread.
struct PairScratch {
  std::vector<ClusterSample> samples;
  TriangleTable triangles, near;  // triangles of the cluster, and those near a group
  SurvivorTable survivors;
  std::vector<std::uint32_t> roots, stack;
  std::vector<std::uint32_t> again;  // triangles (rows of `near`) that vectors of floats cannot decide
  struct Asked {
    std::uint32_t triangle, row, column;
  };
  std::vector<Asked> asked;  // light samples within the error of an edge of a triangle
  struct AskedSlot {
    std::uint32_t triangle, slot;
  };
  std::vector<AskedSlot> asked_slots;          // the same for light samples in tiles
  std::vector<glm::vec3> light_points;         // points of a sphere as one view sample sees it; empty: not computed
  std::vector<std::int32_t> row_and_from, to;  // spans of columns
  Blocked blocked;
  Open open;
  std::uint64_t pairs = 0, careful = 0;  // counts of pairs (view sample, triangle)
};

/// Input of the test of one triangle for one view sample, in double, at any position. The test adds light samples that
/// are certainly blocked to `blocked`, and uncertain ones that are not blocked yet to `open`.
struct CarefulInput {
  const PairInput& in;
  const ClusterSample& at;
  std::uint32_t slot;  ///< slot in the tree's leaves
};
void test_carefully(const CarefulInput& input, Blocked& blocked, Open& open);
/// Tests one light sample against the triangle.
void test_one(const CarefulInput& input, std::uint32_t row, std::uint32_t column, Blocked& blocked, Open& open);

/// Returns whether the triangle hides light sample l, as stored (for a sphere: as this view sample sees it); nullopt if
/// double is not certain.
std::optional<bool> hides(const CarefulInput& input, const glm::vec3& l);

/// One triangle for one view sample and light samples in tiles, in double, at any position. It has four functions of a
/// place in cells, at + x per_x + y per_y, each divided by its largest value and known to ±near. The triangle hides the
/// light samples where all four have the sign `side`: p's side of the triangle's plane, 1 or −1. If `side` is 0, p is
/// within rounding of the plane, and either sign may hold.
struct CellPlanes {
  struct Plane {
    float at = 0, per_x = 0, per_y = 0, near = 0;
  };
  std::array<Plane, 4> planes;
  int side = 0;
};
CellPlanes planes_in_cells(const CarefulInput& input);

/// Compute masks: test_tiles for light samples in tiles, test_pairs for those in rows. `masks`: one for each view
/// sample; all of its bits are written or none.
void test_tiles(const PairInput& input, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks);
void test_pairs(const PairInput& input, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks);

}  // namespace penumbra::vsm
