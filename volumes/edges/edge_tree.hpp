// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/tree/tree_texels.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/normal_cones.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// A hierarchy over edge records that excludes subtrees with k_e = 0. Its nodes have boxes and cones of normals.
namespace penumbra::volumes {

/// Makes a hierarchy over all records of a scene, guided by the tree over its triangles. Its leaves contain indices of
/// records.
visibility::TriangleTree edge_tree(const EdgeRecords& records, const visibility::TriangleTree& triangles);
/// Makes a hierarchy over any records.
visibility::TriangleTree edge_tree(std::span<const EdgeRecord> records);

/// Cones of leaves. In a refit hierarchy, leaves that have not moved keep their cones.
struct LeafCones {
  UnsetList<NormalCone> cones;                      ///< empty: no cone is known
  std::function<bool(std::size_t leaf)> has_moved;  ///< called on all cores
};
/// A child of a hierarchy's node in the format of EdgeTexels.
using EdgeChild = std::array<visibility::Texel, 3>;
/// Passes all children of each node of a hierarchy at once to `take(node, children)`. Both functions are called on all
/// cores.
void for_each_edge_node(const visibility::TriangleTree& tree, float scale,
                        const std::function<LeafNormals(std::size_t leaf)>& normals_of,
                        const std::function<void(std::size_t node, std::span<const EdgeChild> children)>& take,
                        LeafCones* kept = nullptr);

/// A hierarchy as texels. Each child of a node has three: the two of visibility::node_texels, and the cone of normals
/// (axis, cosine of its half-angle). Each leaf slot has one in each of six lists: (a, plane 1), (b, plane 2), (n 1),
/// (anchor 1), (n 2), (anchor 2). The integer of the last four is 0 for an empty slot, else 1; that of (anchor 2) is 1
/// + EdgeRecord::cut.
///
/// A cone contains, up to sign, the two normals of each record below such that k_e(p) = 0 where p is in front of both,
/// or behind both. Cosine 0: at least one record below has no second normal, or normals point in all directions.
struct EdgeTexels {
  std::vector<visibility::Texel> nodes;
  std::array<std::vector<visibility::Texel>, 6> slots;
  std::uint32_t depth = 0;
  std::uint32_t records = 0;
};
EdgeTexels edge_texels(const EdgeRecords& records, const visibility::TriangleTree& triangles, float scale);
EdgeTexels edge_texels(std::span<const EdgeRecord> records, float scale);

}  // namespace penumbra::volumes
