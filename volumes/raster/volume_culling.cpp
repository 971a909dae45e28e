// SPDX-License-Identifier: Apache-2.0
// Reduced shadow volumes: D. B. Lloyd, J. Wendt, N. Govindaraju, D. Manocha, CC shadow volumes, EGSR 2004; M. Stich, C.
// Wächter, A. Keller, Efficient and robust shadow volumes using hierarchical occlusion culling and geometry shaders,
// GPU Gems 3, 2007; S. Laine, Split-plane shadow volumes, Graphics Hardware 2005. Departures: a caster is tested
// against the view samples themselves, in cells of directions from the light, where the papers draw bounding boxes and
// query the number of passing fragments; stretches (intervals of depth) lie between planes perpendicular to each
// caster's axis, where Lloyd's slices contain the eye.

#include "volumes/raster/volume_culling.hpp"

#include "base/parallel.hpp"
#include "volumes/raster/receiver_cells.hpp"
#include "volumes/raster/small_vectors.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// Factor of depth by which a triangle must be farther than a covering caster to be omitted: objects that coincide with
/// the covering caster are kept.
constexpr double kBehind = 1.02;
constexpr std::size_t kMostStretches = 4;

std::array<glm::dvec3, 3> from(const glm::vec3& l, const std::array<glm::vec3, 3>& corners) {
  std::array<glm::dvec3, 3> result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = glm::dvec3(corners[i]) - glm::dvec3(l);
  return result;
}

/// Upper bounds, for each cell, of the depth of a caster that covers the whole cell; infinite if there is none.
class Covers {
 public:
  Covers() : depth_(ReceiverCells::kCells, kUnbounded), most_(ReceiverCells::kCells), state_(ReceiverCells::kCells) {}

  /// Adds the caps and silhouette edges of one caster. In a cell that no silhouette edge crosses, the caster covers
  /// every direction if it covers the cell's middle.
  void add(const glm::vec3& l, std::span<const VolumeCap* const> caps, std::span<const VolumeEdge* const> edges) {
    for (const VolumeCap* cap : caps) {
      const std::array<glm::dvec3, 3> corners = from(l, cap->corners);
      const PlaneDepths plane(corners);
      for (const CellBlock& block : blocks_of(corners)) {
        for (std::uint32_t y = block.first[1]; y <= block.last[1]; ++y) {
          for (std::uint32_t x = block.first[0]; x <= block.last[0]; ++x) {
            const std::size_t cell = ReceiverCells::cell_of(block.face, x, y);
            touch(cell);
            most_[cell] = std::max(most_[cell], plane.in(block, x, y).most);
            if (plane.covers_middle(block.face, x, y)) state_[cell] |= kCovered;
          }
        }
      }
    }
    for (const VolumeEdge* edge : edges) {
      for_each_cell_along(glm::dvec3(edge->a) - glm::dvec3(l), glm::dvec3(edge->b) - glm::dvec3(l),
                          [&](std::size_t cell) { state_[cell] &= static_cast<std::uint8_t>(~kCovered); });
    }
    for (const std::size_t cell : touched_) {
      if ((state_[cell] & kCovered) != 0) depth_[cell] = std::min(depth_[cell], most_[cell]);
      most_[cell] = 0;
      state_[cell] = 0;
    }
    touched_.clear();
  }

  [[nodiscard]] double depth(std::size_t cell) const { return depth_[cell]; }

 private:
  static constexpr std::uint8_t kTouched = 1, kCovered = 2;
  void touch(std::size_t cell) {
    if ((state_[cell] & kTouched) != 0) return;
    state_[cell] |= kTouched;
    touched_.push_back(cell);
  }

  std::vector<double> depth_, most_;
  std::vector<std::uint8_t> state_;
  std::vector<std::size_t> touched_;
};

/// Calls visit(cluster) for the clusters that a triangle may be in front of, until visit returns false. If `covers` is
/// not null, omits cells in which another caster hides all that the triangle could hide.
template <typename Visit>
void for_each_behind(const ReceiverCells& cells, const Covers* covers, const VolumeCap& cap, const glm::vec3& l,
                     Visit&& visit) {
  const std::array<glm::dvec3, 3> corners = from(l, cap.corners);
  const PlaneDepths plane(corners);
  for (const CellBlock& block : blocks_of(corners)) {
    for (std::uint32_t y = block.first[1]; y <= block.last[1]; ++y) {
      for (std::uint32_t x = block.first[0]; x <= block.last[0]; ++x) {
        const std::size_t cell = ReceiverCells::cell_of(block.face, x, y);
        const std::span<const ReceiverCells::Cluster> here = cells.in(cell);
        if (here.empty()) continue;
        const double least = plane.in(block, x, y).least;
        if (covers != nullptr && covers->depth(cell) * kBehind < least) continue;
        for (const ReceiverCells::Cluster& cluster : here) {
          if (cluster.plane == cap.plane || cluster.depth < least * (1 - 1e-6)) continue;
          if (!visit(cluster)) return;
        }
      }
    }
  }
}

/// Intervals of depth along a caster's axis; overlapping ones are merged.
class Stretches {
 public:
  void add(double lower, double upper) {
    all_.emplace_back(lower, upper);
    if (all_.size() > 4096) join(0);
  }

  /// Merges stretches until at most `most` remain, across the narrowest gaps first. Always closes gaps below a tenth of
  /// the whole range.
  std::vector<std::pair<double, double>> few(std::size_t most) {
    join(0);
    if (all_.empty()) return {};
    join(0.1 * (all_.back().second - all_.front().first));
    while (all_.size() > most) {
      double narrowest = kUnbounded;
      for (std::size_t i = 1; i < all_.size(); ++i) {
        narrowest = std::min(narrowest, all_[i].first - all_[i - 1].second);
      }
      join(narrowest);
    }
    return all_;
  }

 private:
  void join(double gap) {
    std::ranges::sort(all_);
    std::vector<std::pair<double, double>> joined;
    for (const auto& [lower, upper] : all_) {
      if (!joined.empty() && lower - joined.back().second <= gap) {
        joined.back().second = std::max(joined.back().second, upper);
      } else {
        joined.emplace_back(lower, upper);
      }
    }
    all_ = std::move(joined);
  }
  std::vector<std::pair<double, double>> all_;
};

struct Caster {
  std::vector<const VolumeCap*> caps;
  std::vector<const VolumeEdge*> edges;
  glm::dvec3 axis{0};           // unit, from l toward the middle of the caster's box
  double nearest = 0, end = 0;  // range of the corners along the axis; nearest is -infinity if the caster cannot be cut
};

/// Least cosine between the axis and the direction of each corner, for a caster that planes across the axis can cut.
constexpr double kLeastCosine = 0.05;

std::vector<Caster> casters_in(const LightVolumes& volumes, const std::vector<std::uint32_t>& components) {
  std::uint32_t count = 0;
  for (const std::uint32_t component : components) count = std::max(count, component + 1);
  std::vector<Caster> casters(count);
  for (const VolumeCap& cap : volumes.caps) casters[components[cap.caster]].caps.push_back(&cap);
  for (const VolumeEdge& edge : volumes.edges) casters[components[edge.caster]].edges.push_back(&edge);
  std::erase_if(casters, [](const Caster& caster) { return caster.caps.empty(); });
  for_each_index(casters.size(), [&](std::size_t i) {
    Caster& caster = casters[i];
    glm::dvec3 lower(kUnbounded), upper(-kUnbounded);
    for (const VolumeCap* cap : caster.caps) {
      for (const glm::dvec3& x : from(volumes.l, cap->corners)) {
        lower = glm::min(lower, x);
        upper = glm::max(upper, x);
      }
    }
    const glm::dvec3 middle = 0.5 * (lower + upper);
    if (!(glm::length(middle) > 0)) return;
    caster.axis = glm::normalize(middle);
    caster.nearest = kUnbounded;
    for (const VolumeCap* cap : caster.caps) {
      for (const glm::dvec3& x : from(volumes.l, cap->corners)) {
        const double along = glm::dot(caster.axis, x);
        caster.nearest = std::min(caster.nearest, along >= kLeastCosine * glm::length(x) ? along : -kUnbounded);
        caster.end = std::max(caster.end, along);
      }
    }
  });
  return casters;
}

/// A caster, and the part of its volume that is drawn.
struct PartOf {
  const Caster* caster;
  gpu::VolumePart part;
};
/// Returns the volumes with the caps and edges of `parts` only.
LightVolumes assembled(const LightVolumes& all, std::span<const PartOf> parts) {
  LightVolumes result{all.l, {}, {}, all.left_out, {}};
  for (const auto& [caster, part] : parts) {
    const auto number = static_cast<std::uint32_t>(result.parts.size());
    result.parts.push_back(part);
    for (const VolumeCap* cap : caster->caps) {
      result.caps.push_back(*cap);
      result.caps.back().part = number;
    }
    for (const VolumeEdge* edge : caster->edges) {
      result.edges.push_back(*edge);
      result.edges.back().part = number;
    }
  }
  return result;
}

/// Restores all triangles of a caster whose remaining triangles have more silhouette edges than the whole caster: each
/// silhouette edge costs a face of the volume.
void keep_simple(const ShadowCasters& casters, const glm::vec3& l, const Light& light,
                 std::vector<std::uint8_t>& kept) {
  const std::vector<std::uint32_t> components = casters.components();
  const auto edges_of = [&](const LightVolumes& volumes) {
    std::vector<std::size_t> edges(components.size());
    for (const VolumeEdge& edge : volumes.edges) ++edges[components[edge.caster]];
    return edges;
  };
  const std::vector<std::size_t> all = edges_of(casters.seen_from(l, light)),
                                 some = edges_of(casters.seen_from(l, light, kept));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (some[components[i]] > all[components[i]]) kept[i] = 1;
  }
}

}  // namespace

LeanVolumes culled_and_clamped(const SceneFloats& scene, const ShadowCasters& casters, const Light& light,
                               const ViewSamples& samples) {
  const glm::vec3 l = visibility::center_of(light);
  const LightVolumes all = casters.seen_from(l, light);
  const std::vector<Caster> groups = casters_in(all, casters.components());
  const ReceiverCells cells(scene, light, l, samples);
  Covers covers;
  for (const Caster& caster : groups) covers.add(l, caster.caps, caster.edges);
  struct Lean {
    bool hides = false;
    std::vector<gpu::VolumePart> parts;
  };
  std::vector<Lean> lean(groups.size());
  for_each_index(groups.size(), [&](std::size_t i) {
    const Caster& caster = groups[i];
    const bool can_be_cut = caster.nearest > 0;
    Stretches stretches;
    for (const VolumeCap* cap : caster.caps) {
      for_each_behind(cells, &covers, *cap, l, [&](const ReceiverCells::Cluster& cluster) {
        lean[i].hides = true;
        const glm::dvec3 low = caster.axis * cluster.lower, high = caster.axis * cluster.upper;
        const glm::dvec3 least = glm::min(low, high), most = glm::max(low, high);
        stretches.add(least.x + least.y + least.z, most.x + most.y + most.z);
        return can_be_cut;  // a caster that cannot be cut keeps its whole volume
      });
      if (lean[i].hides && !can_be_cut) break;
    }
    if (!lean[i].hides) return;
    if (!can_be_cut) {
      lean[i].parts.emplace_back();
      return;
    }
    for (const auto& [lower, upper] : stretches.few(kMostStretches)) {
      const double room = 1e-6 * (std::abs(lower) + std::abs(upper));
      if (upper + room <= caster.nearest) continue;  // in front of the whole caster
      gpu::VolumePart part{};
      store(part.axis, caster.axis);
      part.lower = lower - room;
      part.upper = std::max(upper, caster.end) + room;
      part.bounds = gpu::kHasUpper | (part.lower > caster.end + room ? gpu::kHasLower : 0U);
      if ((part.bounds & gpu::kHasLower) == 0 && !lean[i].parts.empty()) lean[i].parts.pop_back();
      lean[i].parts.push_back(part);
    }
  });
  std::vector<PartOf> parts;
  LeanVolumes result;
  std::vector<std::uint8_t> gone(scene.triangles.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const gpu::VolumePart& part : lean[i].parts) parts.push_back({&groups[i], part});
    result.counters["volumes"] += 1;
    result.counters["culledVolumes"] += lean[i].hides ? 0 : 1;
    result.counters["clampedVolumes"] +=
        lean[i].hides && (lean[i].parts.empty() || lean[i].parts[0].bounds != 0) ? 1 : 0;
    result.counters["stretches"] += lean[i].parts.size();
    if (lean[i].hides) continue;
    for (const VolumeCap* cap : groups[i].caps) gone[casters.numbers()[cap->caster]] = 1;
  }
  result.volumes = assembled(all, parts);
  std::vector<std::uint8_t>& left_out = result.volumes.left_out;
  left_out.resize(scene.triangles.size());
  for (std::size_t i = 0; i < gone.size(); ++i) left_out[i] |= gone[i];
  return result;
}

LeanVolumes culled_by_hierarchy(const SceneFloats& scene, const ShadowCasters& casters,
                                const visibility::TriangleTree& tree, const Light& light, const ViewSamples& samples) {
  using visibility::TriangleTree;
  const glm::vec3 l = visibility::center_of(light);
  const ReceiverCells cells(scene, light, l, samples);
  const auto box_hides = [&](const glm::vec3& lower, const glm::vec3& upper) {
    for (const CellBlock& block : blocks_of_box(glm::dvec3(lower) - glm::dvec3(l), glm::dvec3(upper) - glm::dvec3(l))) {
      for (std::uint32_t y = block.first[1]; y <= block.last[1]; ++y) {
        for (std::uint32_t x = block.first[0]; x <= block.last[0]; ++x) {
          for (const ReceiverCells::Cluster& cluster : cells.in(ReceiverCells::cell_of(block.face, x, y))) {
            if (cluster.depth >= block.least * (1 - 1e-6)) return true;
          }
        }
      }
    }
    return false;
  };
  std::vector<std::uint8_t> hides(scene.triangles.size());
  std::vector<std::uint32_t> stack, leaves;
  std::uint64_t nodes = 0, culled = 0;
  if (!tree.nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const TriangleTree::Node& node = tree.nodes[stack.back()];
    stack.pop_back();
    for (const TriangleTree::Child& child : node) {
      if (child.reference == TriangleTree::kNoChild) continue;
      ++nodes;
      if (!box_hides(child.lower, child.upper)) {
        ++culled;
      } else if ((child.reference & TriangleTree::kLeafBit) != 0) {
        leaves.push_back(child.reference & ~TriangleTree::kLeafBit);
      } else {
        stack.push_back(child.reference);
      }
    }
  }
  for_each_index(leaves.size(), [&](std::size_t i) {
    for (const std::uint32_t triangle : tree.leaves[leaves[i]]) {
      if (triangle == TriangleTree::kNoTriangle) continue;
      const VolumeCap cap{scene.corners(triangle), scene.plane[triangle], 0, 0};
      for_each_behind(cells, nullptr, cap, l, [&](const ReceiverCells::Cluster&) {
        hides[triangle] = 1;
        return false;
      });
    }
  });
  std::vector<std::uint8_t> kept(casters.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = hides[casters.numbers()[i]];
  keep_simple(casters, l, light, kept);
  LeanVolumes result{casters.seen_from(l, light, kept), {}};
  result.counters = {{"volumes", casters.size()},
                     {"culledVolumes", static_cast<std::uint64_t>(std::ranges::count(kept, 0))},
                     {"visitedNodes", nodes},
                     {"culledNodes", culled}};
  return result;
}

LeanVolumes split_by_planes(const ShadowCasters& casters, const Light& light, const ViewSamples& samples) {
  const LightVolumes all = casters.seen_from(visibility::center_of(light), light);
  const std::vector<Caster> groups = casters_in(all, casters.components());
  const glm::dvec3 eye = samples.camera.eye - glm::dvec3(all.l);
  std::vector<PartOf> parts;
  for (const Caster& caster : groups) {
    gpu::VolumePart part{};
    store(part.barrier, eye - caster.axis * glm::dot(caster.axis, eye));
    part.bounds = gpu::kToggles;
    parts.push_back({&caster, part});
  }
  LeanVolumes result{assembled(all, parts), {}};
  result.counters["volumes"] = groups.size();
  return result;
}

}  // namespace penumbra::volumes
