// SPDX-License-Identifier: Apache-2.0
// Hierarchies of edges for vector units: their leaves, made on demand, and their cuts at a light's plane.

#include "volumes/edges/vectors/cut.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace penumbra::volumes {
namespace {

using vectors::WideEdges;
using vectors::WideNode;
using vectors::WidePoints;

glm::vec3 point(const WidePoints& points, std::size_t lane) {
  return {points[0][lane], points[1][lane], points[2][lane]};
}

}  // namespace

/// Adapter for cut_hierarchy: dropped children and records are marked as unused.
class CutEdges::Dropping {
 public:
  Dropping(CutEdges& edges, float scale) : edges_(edges), tree_(edges.tree_), scale_(scale) {}

  [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return tree_.roots; }
  [[nodiscard]] std::uint32_t reference(std::uint32_t node, std::uint32_t child) const {
    const WideNode& at = tree_.nodes[node];
    return (at.used >> child & 1U) != 0 ? at.reference[child] : visibility::TriangleTree::kNoChild;
  }
  [[nodiscard]] glm::vec3 middle(std::uint32_t node, std::uint32_t child) const {
    return point(tree_.nodes[node].middle, child);
  }
  [[nodiscard]] glm::vec3 half(std::uint32_t node, std::uint32_t child) const {
    return point(tree_.nodes[node].half, child);
  }
  void drop_child(std::uint32_t node, std::uint32_t child) { drop(tree_.nodes[node].used, edges_.nodes_, node, child); }

  [[nodiscard]] bool has_record(std::uint32_t leaf, std::uint32_t slot) const {
    return (tree_.leaves[leaf].used >> slot & 1U) != 0;
  }
  [[nodiscard]] EdgeRecord record(std::uint32_t leaf, std::uint32_t slot) const {
    const WideEdges& edges = tree_.leaves[leaf];
    const auto unscaled = [&](const WidePoints& points) { return point(points, slot) / scale_; };
    EdgeRecord record{unscaled(edges.a), unscaled(edges.b), {}};
    for (std::size_t i = 0; i < 2; ++i) {
      record.sides[i] = {point(edges.n[i], slot), unscaled(edges.anchor[i]), edges.plane[i][slot]};
    }
    return record;
  }
  void drop_record(std::uint32_t leaf, std::uint32_t slot) {
    drop(tree_.leaves[leaf].used, edges_.leaves_, leaf, slot);
  }

 private:
  static void drop(std::uint32_t& used, std::vector<Used>& before, std::uint32_t number, std::uint32_t lane) {
    before.push_back({number, used});
    used &= ~(1U << lane);
  }

  CutEdges& edges_;
  vectors::WideEdgeTree& tree_;
  float scale_;
};

namespace {

void store(WidePoints& points, std::size_t lane, const glm::vec3& x) {
  for (int axis = 0; axis < 3; ++axis) points[static_cast<std::size_t>(axis)][lane] = x[axis];
}

/// Predicate that excludes no record.
constexpr auto kAllUsed = [](std::uint32_t) { return true; };

std::array<glm::vec3, 2> normals_at(const EdgeRecords& records, std::size_t record) {
  return records.normals(record);
}
std::array<glm::vec3, 2> normals_at(const std::vector<EdgeRecord>& records, std::size_t record) {
  return {records[record].sides[0].n, records[record].sides[1].n};
}

/// Fills one leaf of a tree over records with those in use.
template <typename Records, typename IsUsed>
void fill(const visibility::TriangleTree::Leaf& slots, const Records& records, const IsUsed& is_used, float scale,
          WideEdges& leaf) {
  for (std::size_t lane = 0; lane < slots.size() && slots[lane] != visibility::TriangleTree::kNoTriangle; ++lane) {
    if (!is_used(slots[lane])) continue;
    const EdgeRecord record = records[slots[lane]];
    store(leaf.a, lane, record.a * scale);
    store(leaf.b, lane, record.b * scale);
    for (std::size_t side = 0; side < 2; ++side) {
      leaf.plane[side][lane] = record.sides[side].plane;
      store(leaf.n[side], lane, record.sides[side].n);
      store(leaf.anchor[side], lane, record.sides[side].anchor * scale);
    }
    leaf.cut[lane] = record.cut;
    leaf.used |= 1U << lane;
  }
}

/// Adds the nodes above the leaves.
template <typename Records, typename IsUsed>
void add_nodes(vectors::WideEdgeTree& wide, const visibility::TriangleTree& tree, const Records& records,
               const IsUsed& is_used, float scale, LeafCones* kept = nullptr) {
  if (tree.nodes.empty()) return;
  wide.roots = {0};
  const auto normals_of = [&](std::size_t number) {
    LeafNormals normals;
    for (const std::uint32_t record : tree.leaves[number]) {
      if (record == visibility::TriangleTree::kNoTriangle) break;
      if (is_used(record)) normals.n[normals.count++] = normals_at(records, record);
    }
    return normals;
  };
  if (wide.nodes.empty()) wide.nodes.resize(tree.nodes.size());
  for_each_edge_node(
      tree, scale, normals_of,
      [&](std::size_t node, std::span<const EdgeChild> children) {
        WideNode& at = wide.nodes[node] = {};
        for (std::size_t lane = 0; lane < children.size(); ++lane) vectors::store(at, lane, children[lane]);
      },
      kept);
}

}  // namespace

vectors::WideEdgeTree wide_edges(EdgeRecords records, const visibility::TriangleTree& triangles, float scale) {
  struct Source {
    EdgeRecords records;
    visibility::TriangleTree tree;
  };
  visibility::TriangleTree tree = edge_tree(records, triangles);
  const auto source = std::make_shared<Source>(Source{std::move(records), std::move(tree)});
  vectors::WideEdgeTree wide;
  add_nodes(wide, source->tree, source->records, kAllUsed, scale);
  source->tree.nodes = decltype(source->tree.nodes)();  // (= {} would keep the memory)
  wide.leaves.make(
      source->tree.leaves.size(),
      [source, scale](std::size_t number, WideEdges& leaf) {
        fill(source->tree.leaves[number], source->records, kAllUsed, scale, leaf);
      },
      source->records.memory_bytes() + vectors::bytes_of(source->tree));
  return wide;
}

vectors::WideEdgeTree wide_edges(const EdgeRecords& records, const visibility::TriangleTree& tree, float scale,
                                 WideEdgesBefore before) {
  vectors::WideEdgeTree wide = std::move(before.edges);
  const auto is_used = [&](std::uint32_t record) { return !records.is_flat(record); };
  const auto make = [&](std::size_t number, WideEdges& leaf) {
    fill(tree.leaves[number], records, is_used, scale, leaf);
  };
  if (wide.leaves.empty()) {
    wide.leaves.make_now(tree.leaves.size(), make);
  } else {
    PENUMBRA_ASSERT(wide.leaves.size() == tree.leaves.size(), "{} leaves of {}", wide.leaves.size(),
                    tree.leaves.size());
    wide.leaves.make_again(before.cones.has_moved, make);
  }
  add_nodes(wide, tree, records, is_used, scale, &before.cones);
  return wide;
}

vectors::WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records, float scale) {
  const visibility::TriangleTree tree = edge_tree(records);
  vectors::WideEdgeTree wide;
  wide.leaves.make_now(tree.leaves.size(), [&](std::size_t number, WideEdges& leaf) {
    fill(tree.leaves[number], records, kAllUsed, scale, leaf);
  });
  add_nodes(wide, tree, records, kAllUsed, scale);
  return wide;
}

void CutEdges::restore() {
  if (!is_cut_) return;
  ends_.reset();
  plane_of_light_ = vectors::Cluster::kSeveral;
  // In reverse order: if an entry was changed several times, its first saved value is the original one.
  std::for_each(nodes_.rbegin(), nodes_.rend(), [&](const auto& node) { tree_.nodes[node.number].used = node.used; });
  std::for_each(leaves_.rbegin(), leaves_.rend(),
                [&](const auto& leaf) { tree_.leaves[leaf.number].used = leaf.used; });
  nodes_.clear();
  leaves_.clear();
  tree_.roots.resize(roots_);
  tree_.nodes.resize(nodes_count_);
  tree_.leaves.forget_appended();
  is_cut_ = false;
}

void CutEdges::leave_out(std::span<const EdgeSlot> slots) {
  restore();
  is_cut_ = true;
  roots_ = tree_.roots.size();
  nodes_count_ = tree_.nodes.size();
  for (const auto& [leaf, lane] : slots) {
    leaves_.push_back({leaf, tree_.leaves[leaf].used});
    tree_.leaves[leaf].used &= ~(1U << lane);
  }
}

void CutEdges::cut(const CutInput& input, std::span<const EdgeSlot> without) {
  leave_out(without);
  if (input.exact_ends) ends_.emplace(input.side);
  const std::vector<std::uint32_t> across = triangles_across(input);
  for (const std::uint32_t triangle : across) {
    const auto corners = input.scene.corners(triangle);
    const bool in_plane = std::ranges::all_of(corners, [&](const auto& x) { return input.side.place_of(x) == 0; });
    if (in_plane) plane_of_light_ = input.scene.plane[triangle];
  }
  std::vector<EdgeRecord> records =
      edges_in_plane(input.scene, input.casters, across, input.side, ends_ ? &*ends_ : nullptr);
  Dropping dropping(*this, input.side.scale);
  cut_hierarchy(dropping, input.side, ends_ ? &*ends_ : nullptr, records);
  vectors::append(tree_, wide_edges(records, input.side.scale));
}

}  // namespace penumbra::volumes
