// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/find.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>

/// Signed edges on a processor: tables passed between stages. Inside volumes/ only.
namespace penumbra::volumes {

// Names from engines/vectors/ that the tables are made of.
using vectors::Cluster;
using vectors::ClusterSample;
using vectors::count_edge_leaves;
using vectors::count_leaves;
using vectors::EdgeInput;
using vectors::EdgeTable;
using vectors::GridSample;
using vectors::HorizonLine;
using vectors::Hull;
using vectors::kRound;
using vectors::kWide;
using vectors::LightCone;
using vectors::LightGrid;
using vectors::LightTiles;
using vectors::narrow_edge_roots;
using vectors::narrow_triangle_roots;
using vectors::Open;
using vectors::OpenJudge;
using vectors::Placing;
using vectors::SampleMask;
using vectors::Table;
using vectors::TriangleTable;
using vectors::WideEdges;
using vectors::WideEdgeTree;
using vectors::WidePoints;
using vectors::WideTriangles;
using vectors::WideTriangleTree;
using enum vectors::EdgeField;
using enum vectors::TriangleField;

/// Columns of an edge that affects a group of view samples: the first 18 of EdgeField, then the error bound of the
/// places of its ends (for a sphere or sun: kFar), and its row in the EdgeTable (as bits).
enum GroupField : std::size_t { kGroupError = kPlane2 + 1, kGroupEdge, kGroupFields };
using GroupTable = Table<kGroupFields>;

/// Columns of an edge that affects one view sample: places of its ends, k, the group's error, its row in the EdgeTable.
enum CrossingField : std::size_t { kX0, kY0, kX1, kY1, kK, kError, kEdge, kCrossingFields };
constexpr std::uint32_t kUnsettled = 0x80000000U;                    ///< in kEdge: the edge may come near p's height
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();  ///< in kK: float leaves the multiplicity open
constexpr std::uint32_t kDiskCut = 0x7fffffffU;  ///< in kEdge: not an edge of a mesh (disk_cuts.hpp)
using CrossingTable = Table<kCrossingFields>;

}  // namespace penumbra::volumes
