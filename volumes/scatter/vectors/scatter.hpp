#pragma once

#include "engines/vectors/find.hpp"
#include "engines/vectors/frame.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/light_touch.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/scatter/vectors/areas_on_demand.hpp"
#include "volumes/edges/cut_ends.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Edge scatter on a processor: what its stages hand to one another. Inside volumes/ only.
namespace penumbra::volumes {

using namespace native;  // NOLINT(google-build-using-namespace): its fields and tables by the dozen

/// Of an edge that matters to a group of view samples: the first 18 of EdgeField, then a bound of the error of where
/// its ends appear, and its row in the EdgeTable (bits).
enum GroupField : std::size_t { kGroupError = kPlane2 + 1, kGroupEdge, kGroupFields };
using GroupTable = Table<kGroupFields>;

/// Of an edge that matters to one view sample: where its ends appear, k, the group's error, its row in the EdgeTable.
enum CrossingField : std::size_t { kX0, kY0, kX1, kY1, kK, kError, kEdge, kCrossingFields };
constexpr std::uint32_t kUnsettled = 0x80000000U;  ///< in kEdge: it may come near p's height
using CrossingTable = Table<kCrossingFields>;

struct ScatterInput {
  const Frame& frame;
  const visibility::LightTouch& touch;
  const WideEdgeTree& edge_tree;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const Sample> samples;
  const EdgeTable& edges;
  const TriangleTable& triangles;
  std::size_t group;          ///< view samples that sort out edges together
  bool between_rows;          ///< edges that cross no light row matter, too
  const CutEnds* ends;        ///< of edges of the tree (WideEdges::cut); null: none is cut
  std::uint32_t light_plane;  ///< CutEdges::plane_of_light
};
/// What of a view sample is open before anything is looked at: light samples that something touches.
void begin(const Frame& frame, const visibility::LightTouch& touch, const Placed& at, Open& open);
/// What matters to a group of view samples. Settled edges stay well above all of its p.
struct GroupLists {
  GroupTable settled, unsettled;
  TriangleTable triangles;
};
void sort_out(const ScatterInput& input, std::span<const Sample> group, GroupLists& lists);

/// How many triangles the segment from p to the light's lower left corner meets. One is as good as many where no edge
/// changes the count (`one_will_do`).
struct CornerInput {
  const Frame& frame;
  const WideTriangleTree& tree;
  const TriangleTable& triangles;
  const Sample& at;
  bool one_will_do;
  std::uint32_t light_plane;  ///< of triangles in it nothing is before the light
};
std::uint32_t count_to_corner(const CornerInput& input, Open& open);

/// Buffers of one thread.
struct Scratch {
  std::vector<Sample> samples;
  EdgeTable edges;
  TriangleTable triangles;
  GroupLists lists;
  CrossingTable crossing;
  std::vector<std::uint32_t> edge_roots, triangle_roots, stack;
  bool dense = false;                       // the region (kDense)
  std::vector<std::int32_t> landing, jump;  // scattered changes: where in the histogram, and by how much
  std::vector<std::int16_t> histogram, left;
  std::vector<std::int32_t> wide_histogram, wide_left;
  Open open;
  std::uint64_t listed = 0, dense_regions = 0, unproven = 0;  // counted
};

/// `seen`: one a view sample; of its mask all or nothing is written.
void scatter(const ScatterInput& input, Scratch& scratch, Judge& judge, std::span<Seen> seen);

/// Not light samples but the light: `shares` of it that are visible (RowSum). A view sample whose share double cannot
/// prove gets it from integers (areas::ExactArea). `radiance`, if there: form factors of what is visible.
struct Integral {
  std::span<float> shares;
  std::span<double> radiance;
};
struct IntegralInput {
  const ScatterInput& scatter;
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const visibility::ViewSamples& samples;
  AreasOnDemand& areas;
  float scale;  ///< visibility::device_scale
};
void integrate(const IntegralInput& input, Scratch& scratch, Judge& judge, const Integral& out);

}  // namespace penumbra::volumes
