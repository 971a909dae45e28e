#pragma once

#include "engines/vectors/find.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>

/// Signed edges on a processor: the tables that its stages hand to one another. Inside volumes/ only.
namespace penumbra::volumes {

// From engines/vectors/, by name: what the stages here hand to one another is made of these.
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

/// Of an edge that matters to a group of view samples: the first 18 of EdgeField, then a bound of the error of where
/// its ends appear (of a sphere or sun: kFar), and its row in the EdgeTable (bits).
enum GroupField : std::size_t { kGroupError = kPlane2 + 1, kGroupEdge, kGroupFields };
using GroupTable = Table<kGroupFields>;

/// Of an edge that matters to one view sample: where its ends appear, k, the group's error, its row in the EdgeTable.
enum CrossingField : std::size_t { kX0, kY0, kX1, kY1, kK, kError, kEdge, kCrossingFields };
constexpr std::uint32_t kUnsettled = 0x80000000U;                    ///< in kEdge: it may come near p's height
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();  ///< in kK: which float leaves open
constexpr std::uint32_t kDiskCut = 0x7fffffffU;  ///< in kEdge: it is no edge of a mesh (disk_cuts.hpp)
using CrossingTable = Table<kCrossingFields>;

}  // namespace penumbra::volumes
