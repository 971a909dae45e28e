#pragma once

#include "visibility/light_frame.hpp"
#include "volumes/native_trees.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// Edge scatter on a processor: what its stages hand to one another. Inside volumes/ only. docs/edge-scatter.md derives
/// every bound; names are those of the device's passes (edge_scatter.glsl).
namespace penumbra::volumes::native {

constexpr float kRound = 0x1p-24F;  ///< half a unit in the last place of 1

/// The light as a frame for (X, Y), in cells, as seen from one of its sides.
struct Frame {
  glm::vec3 center{0}, axis{0}, across{0}, along{0};
  glm::vec2 half_cells{0}, first_cell{0};
  glm::dvec3 corner{0};  ///< of the light: where its rows and columns begin
  float per_length = 0, skew = 1, deviation = 0, reach = 0, cut_reach = 0;
  float side = 1;
  std::uint32_t rows = 0, columns = 0, light = 0;
  std::uint32_t padded_rows = 0;  ///< to a multiple of 16
  std::vector<float> shift;       ///< of each (padded) row, in cells
};
struct FrameInput {
  const visibility::LightFrame& light;
  std::uint32_t rows, columns, light_index;
  float side, reach, cut_reach;
};
Frame make_frame(const FrameInput& input);

/// A view sample that the light is, or may be, before.
struct Placed {
  glm::vec3 p{0};  ///< scaled
  std::uint32_t pixel = 0, plane = 0;
  float height = 0;  ///< over the light's plane
  glm::vec2 foot{0};
  /// Light samples with above · (s, t, 1) > above_error are above the carrier's plane; < −above_error: below it.
  /// (bound horizon)
  glm::vec3 above{0};
  float above_error = 0;
  bool straddles = false;  ///< not all of the light is certainly above it
};

/// With what is needed once something may be before the light: p relative to its cluster's middle, in world axes and in
/// the frame's (across, along, axis).
struct Sample : Placed {
  glm::vec3 local{0}, seen{0};
  float away = 0;  ///< bounds |p − the light's centre|
  float far = 0;   ///< bounds |local|
  /// The error of a projected point at height w over p, `far_x` from the cluster's middle, that appears F from the
  /// foot: (far_x + far) / w · (per_way + per_reach F) + per_foot F + fixed. (bound X)
  float per_way = 0, per_foot = 0, fixed = 0;
  glm::vec2 lean{0};   ///< the way to the light's corner, in cells for a unit of height
  float per_lean = 0;  ///< the error of a corner's place beside that way is (far_x + far) per_lean (bound corner)
};
constexpr float kPerReach = 8 * kRound;

/// The hull of view samples and a rectangle of the light's plane. (bound shaft)
struct Shaft {
  float lowest = 0, highest = 0;
  std::array<float, 4> nx{}, ny{}, nz{}, beyond{};
};

/// View samples whose lists are found together: their box, and the shafts to the light and to its lower left corner.
struct Cluster {
  glm::vec3 middle{0}, half_size{0};
  Shaft whole, corner;
};
Cluster make_cluster(const Frame& frame, std::span<const Placed> samples);
Sample complete(const Frame& frame, const Cluster& cluster, const Placed& at);

/// Columns of floats, side by side.
template <std::size_t kFields>
class Table {
 public:
  static constexpr std::size_t kSlack = 64;  ///< vectors may be written beyond the last row

  float* operator[](std::size_t field) { return data_.get() + field * capacity_; }
  const float* operator[](std::size_t field) const { return data_.get() + field * capacity_; }
  void reserve(std::size_t rows) {
    if (rows + kSlack <= capacity_) return;
    const std::size_t capacity = (2 * rows + 2 * kSlack + 15) / 16 * 16 + 16;  // + 16: columns begin in different sets
    auto data = hwy::AllocateAligned<float>(kFields * capacity);
    for (std::size_t field = 0; field < kFields && capacity_ > 0; ++field) {
      std::copy_n((*this)[field], count, data.get() + field * capacity);
    }
    std::fill_n(data.get(), capacity_ == 0 ? kFields * capacity : 0, 0.0F);
    data_ = std::move(data);
    capacity_ = capacity;
  }

  std::size_t count = 0;

 private:
  hwy::AlignedFreeUniquePtr<float[]> data_;
  std::size_t capacity_ = 0;
};

/// Of an edge, relative to its cluster: ends in the frame's axes; of its two triangles n, n · anchor, the error of
/// n · p − n · anchor for all of the cluster's p (−1: no triangle), and the plane's number (bits). Then how far its
/// ends and its anchors are from the cluster's middle.
enum EdgeField : std::size_t {
  kAx,
  kAy,
  kAh,
  kBx,
  kBy,
  kBh,
  kN1x,
  kN1y,
  kN1z,
  kD1,
  kE1,
  kPlane1,
  kN2x,
  kN2y,
  kN2z,
  kD2,
  kE2,
  kPlane2,
  kFar,
  kAnchorFar,
  kEdgeFields
};
using EdgeTable = Table<kEdgeFields>;

/// Of an edge that matters to a group of view samples: the first 18 of EdgeField, then a bound of the error of where
/// its ends appear, and its row in the EdgeTable (bits).
enum GroupField : std::size_t { kGroupError = kPlane2 + 1, kGroupEdge, kGroupFields };
using GroupTable = Table<kGroupFields>;

/// Of an edge that matters to one view sample: where its ends appear, k, the group's error, its row in the EdgeTable.
enum CrossingField : std::size_t { kX0, kY0, kX1, kY1, kK, kError, kEdge, kCrossingFields };
using CrossingTable = Table<kCrossingFields>;

enum TriangleField : std::size_t {
  kCornerA,
  kCornerB = 3,
  kCornerC = 6,
  kTrianglePlane = 9,
  kTriangleFar,
  kTriangleSlot,  ///< of the hierarchy's leaves (bits)
  kTriangleFields
};
using TriangleTable = Table<kTriangleFields>;

/// Subtrees (TriangleTree::Child::reference) that hold all that a walk can find.
struct Roots {
  std::vector<std::uint32_t> edges, triangles;
};
struct FindInput {
  const Frame& frame;
  const WideEdgeTree& edges;
  const WideTriangleTree& triangles;
  const Cluster& cluster;
};
/// Where the walks of clusters that are part of this one may begin.
void find_roots(const FindInput& input, Roots& roots);
/// Edges that the shaft to the light meets and that may be silhouettes as seen from the cluster; triangles that the
/// shaft to the light's corner meets.
void find(const FindInput& input, const Roots& from, std::vector<std::uint32_t>& stack, EdgeTable& edges,
          TriangleTable& triangles);

/// What float arithmetic left open of a view sample.
struct Open {
  bool pixel = false;                        ///< all of it
  bool corner = false;                       ///< how many triangles are before the light's corner
  std::vector<std::uint32_t> rows, samples;  ///< light samples: row · columns + column; some twice

  void clear() {
    pixel = corner = false;
    rows.clear();
    samples.clear();
  }
  [[nodiscard]] bool any() const { return pixel || !rows.empty() || !samples.empty(); }
};

/// Visible light samples of a view sample: how many, and, unless all or none are, which: bit column · padded_rows +
/// row.
struct Seen {
  std::uint16_t* mask = nullptr;
  std::uint32_t visible = 0;
};

/// Decides what is open by exact predicates.
class Judge {
 public:
  virtual ~Judge() = default;
  /// How many triangles are before a light sample.
  virtual std::uint32_t depth(const Placed& sample, std::uint32_t light_sample) = 0;
  virtual void decide(const Placed& sample, const Open& open, Seen& seen) = 0;
};

struct ScatterInput {
  const Frame& frame;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const Sample> samples;
  const EdgeTable& edges;
  const TriangleTable& triangles;
};
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
};
std::uint32_t count_to_corner(const CornerInput& input, Open& open);

/// Buffers of one thread.
struct Scratch {
  std::vector<Placed> placed;
  std::vector<Sample> samples;
  std::vector<Seen> seen;
  EdgeTable edges;
  TriangleTable triangles;
  GroupLists lists;
  CrossingTable crossing;
  Roots roots;
  std::vector<std::uint32_t> stack;
  std::vector<std::int32_t> landing, jump;  // scattered changes: where in the histogram, and by how much
  std::vector<std::int16_t> histogram, left;
  std::vector<std::int32_t> wide_histogram, wide_left;
  Open open;
  std::uint64_t open_pixels = 0, open_samples = 0, listed = 0;  // counted
};

/// Where nothing is before the light but the horizon.
void see_all(const Frame& frame, const Placed& at, Open& open, Judge& judge, Seen& seen);
/// `seen`: one a view sample; of its mask all or nothing is written.
void scatter(const ScatterInput& input, Scratch& scratch, Judge& judge, std::span<Seen> seen);

}  // namespace penumbra::volumes::native
