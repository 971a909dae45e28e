#pragma once

#include "engines/vectors/find.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/lights/light_touch.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/scatter/vectors/areas_on_demand.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::areas {
class TextureBlocks;
}

/// Edge scatter on a processor: what its stages hand to one another. Inside volumes/ only.
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

struct ScatterInput {
  const LightGrid& grid;
  const visibility::LightTouch& touch;
  const WideEdgeTree& edge_tree;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const ClusterSample> samples;
  const EdgeTable& edges;
  const TriangleTable& triangles;
  std::size_t group;          ///< view samples that sort out edges together
  bool exact_area;            ///< not of light samples but of the light
  const CutEnds* ends;        ///< of edges of the tree (WideEdges::cut); null: none is cut
  std::uint32_t light_plane;  ///< CutEdges::plane_of_light

  /// Edges that cross no light row matter, too.
  [[nodiscard]] bool between_rows() const { return exact_area || grid.tiles; }
};
/// Sets what of a view sample is open before any caster is tested: light samples that a triangle touches.
void reset_open(const LightGrid& grid, const visibility::LightTouch& touch, const GridSample& at, Open& open);
/// What matters to a group of view samples. Settled edges stay well above all of its p.
struct GroupLists {
  GroupTable settled, unsettled;
  TriangleTable triangles;
};
void sort_out(const ScatterInput& input, std::span<const ClusterSample> group, GroupLists& lists);
/// Calls `visit(i)` for each view sample, with the lists of its group.
template <typename Visit>
void for_each_sample(const ScatterInput& input, GroupLists& lists, Visit visit) {
  for (std::size_t first = 0; first < input.samples.size(); first += input.group) {
    const auto group = input.samples.subspan(first, std::min(input.group, input.samples.size() - first));
    sort_out(input, group, lists);
    for (std::size_t i = first; i < first + group.size(); ++i) visit(i);
  }
}

/// How many triangles the segment from p to the light's lower left corner meets. One is as good as many where no edge
/// changes the count (`one_will_do`).
struct CornerInput {
  const LightGrid& grid;
  const WideTriangleTree& tree;
  const TriangleTable& triangles;
  const ClusterSample& at;
  bool one_will_do;
  std::uint32_t light_plane;  ///< its number: triangles in it are not between p and the light
};
std::uint32_t count_to_corner(const CornerInput& input, Open& open);

/// An edge that vectors leave to scatter_precisely (precise.hpp): k as the table has it.
struct PreciseEdge {
  std::uint32_t edge;  ///< in the EdgeTable
  float k;
  bool settled;
};

/// Buffers of one thread.
struct Scratch {
  std::vector<ClusterSample> samples;
  EdgeTable edges;
  TriangleTable triangles;
  GroupLists lists;
  CrossingTable crossing;
  std::vector<std::uint32_t> edge_roots, triangle_roots, stack;
  std::vector<std::uint32_t> narrow_edge_roots, narrow_triangle_roots, probe_stack;  // of view samples alone
  bool dense = false;                                                                // the region (kDense)
  bool alone = false;                       // so are the view samples of one of the region's clusters
  std::vector<std::int32_t> landing, jump;  // scattered changes: where in the histogram, and by how much
  std::vector<PreciseEdge> precise;
  std::vector<std::int8_t> bytes;  // Changes
  std::vector<std::int16_t> words;
  std::vector<std::int32_t> wide_words;
  std::vector<std::int32_t> tile_changes, row_changes, tile_depths;  // PointChanges
  vectors::SlotFloats depths;                                        // 0 between view samples
  std::vector<std::uint8_t> is_touched;                              // of each tile; 0 between view samples
  std::vector<std::uint32_t> touched;
  Open open;
  std::uint64_t listed = 0, dense_regions = 0, alone_samples = 0, unproven = 0;  // counted
};

/// `masks`: one for each view sample; of its bits all or none are written. scatter_points: light samples in tiles.
void scatter_points(const ScatterInput& input, Scratch& scratch, OpenJudge& judge, std::span<SampleMask> masks);
void scatter(const ScatterInput& input, Scratch& scratch, OpenJudge& judge, std::span<SampleMask> masks);

/// Not light samples but the light: `shares` of it that are visible (RowSum). A view sample whose share double cannot
/// prove gets it from integers (areas::ExactArea). `radiance`, if there: form factors of what is visible, where that is
/// a part of the light.
struct Integral {
  std::span<float> shares;
  std::span<glm::dvec3> radiance;
};
struct LightRegion;
struct IntegralInput {
  const ScatterInput& scatter;
  const LightRegion& region;
  const std::optional<areas::TextureBlocks>& texture;
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const visibility::ViewSamples& samples;
  AreasOnDemand& areas;
  float scale;  ///< visibility::device_scale
};
void integrate(const IntegralInput& input, Scratch& scratch, OpenJudge& judge, const Integral& out);

}  // namespace penumbra::volumes
