#include "volumes/scatter/vectors/cut.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::volumes {
namespace {

using native::kWide;
using native::WideEdges;
using native::WideNode;
using native::WidePoints;
using visibility::TriangleTree;

enum class Place { in_front, behind, across };

/// Of a box. Certain of all but what is across: its corners are closer to the plane than rounding here can be wrong.
Place place_of(const LightSide& side, const glm::dvec3& middle, const glm::dvec3& half) {
  const glm::dvec3 n = side.sign * glm::cross(side.u, side.v), size = glm::abs(n), from = middle - side.center;
  const double spread = glm::dot(size, half);
  const double rounding = 0x1p-20 * glm::dot(size, glm::abs(middle) + half + glm::abs(side.center));
  const double height = glm::dot(n, from);
  if (height > spread + rounding) return Place::in_front;
  return height < -spread - rounding ? Place::behind : Place::across;
}

glm::vec3 point(const WidePoints& points, std::size_t lane) {
  return {points[0][lane], points[1][lane], points[2][lane]};
}

EdgeRecord record_of(const WideEdges& leaf, std::size_t lane, float scale) {
  const auto unscaled = [&](const WidePoints& points) { return point(points, lane) / scale; };
  EdgeRecord record{unscaled(leaf.a), unscaled(leaf.b), {}};
  for (std::size_t i = 0; i < 2; ++i) {
    record.sides[i] = {point(leaf.n[i], lane), unscaled(leaf.anchor[i]), leaf.plane[i][lane]};
  }
  return record;
}

/// Casters whose boxes the plane may cut.
std::vector<std::uint32_t> triangles_across(const CutInput& in) {
  std::vector<std::uint32_t> found, stack;
  if (!in.triangles.nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const TriangleTree::Node& node = in.triangles.nodes[stack.back()];
    stack.pop_back();
    for (const TriangleTree::Child& child : node) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const glm::dvec3 lower(child.lower), upper(child.upper);
      if (place_of(in.side, 0.5 * (lower + upper), 0.5 * (upper - lower)) != Place::across) continue;
      if ((child.reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(child.reference);
        continue;
      }
      for (const std::uint32_t triangle : in.triangles.leaves[child.reference & ~TriangleTree::kLeafBit]) {
        if (triangle == TriangleTree::kNoTriangle) continue;
        if (in.without < 0 || in.scene.emits[triangle] != in.without) found.push_back(triangle);
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

native::WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records, float scale) {
  const EdgeTexels texels = edge_texels(records, scale);
  return texels.depth == 0 ? native::WideEdgeTree{} : native::wide_edge_tree(texels.nodes, texels.slots);
}

void CutEdges::mend() {
  if (!is_cut_) return;
  ends_.reset();
  plane_of_light_ = native::Cluster::kSeveral;
  for (const auto& [node, used] : nodes_) tree_.nodes[node].used = used;
  for (const auto& [leaf, used] : leaves_) tree_.leaves[leaf].used = used;
  nodes_.clear();
  leaves_.clear();
  tree_.roots.resize(roots_);
  tree_.nodes.resize(nodes_count_);
  tree_.leaves.resize(leaves_count_);
  is_cut_ = false;
}

void CutEdges::cut(const CutInput& input) {
  mend();
  is_cut_ = true;
  roots_ = tree_.roots.size();
  nodes_count_ = tree_.nodes.size();
  leaves_count_ = tree_.leaves.size();
  if (input.exact_ends) ends_.emplace(input.side);
  const std::vector<std::uint32_t> across = triangles_across(input);
  for (const std::uint32_t triangle : across) {
    const auto corners = input.scene.corners(triangle);
    const bool in_plane = std::ranges::all_of(corners, [&](const auto& x) { return input.side.place_of(x) == 0; });
    if (in_plane) plane_of_light_ = input.scene.plane[triangle];
  }
  std::vector<EdgeRecord> records =
      edges_in_plane(input.scene, input.casters, across, input.side, ends_ ? &*ends_ : nullptr);
  cut_nodes(input.side, records);
  native::append(tree_, wide_edges(records, input.side.scale));
}

/// Leaves out what is behind the plane; `records` gets what it cuts.
void CutEdges::cut_nodes(const LightSide& side, std::vector<EdgeRecord>& records) {
  const double unscaled = 1 / static_cast<double>(side.scale);
  std::vector<std::uint32_t> stack = tree_.roots;
  while (!stack.empty()) {
    const std::uint32_t number = stack.back();
    stack.pop_back();
    WideNode& node = tree_.nodes[number];
    const std::uint32_t used = node.used;
    for (std::uint32_t left = used; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const Place place = place_of(side, glm::dvec3(point(node.middle, lane)) * unscaled,
                                   glm::dvec3(point(node.half, lane)) * unscaled);
      const std::uint32_t reference = node.reference[lane];
      if (place == Place::behind) node.used &= ~(1U << lane);
      if (place != Place::across) continue;
      if ((reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(reference);
      } else {
        cut_leaf(side, reference & ~TriangleTree::kLeafBit, records);
      }
    }
    if (node.used != used) nodes_.push_back({number, used});
  }
}

void CutEdges::cut_leaf(const LightSide& side, std::uint32_t number, std::vector<EdgeRecord>& records) {
  WideEdges& leaf = tree_.leaves[number];
  const std::uint32_t used = leaf.used;
  for (std::uint32_t left = used; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    EdgeRecord record = record_of(leaf, lane, side.scale);
    const glm::vec3 a = record.a, b = record.b;
    const bool kept = keep_in_front(record, side, ends_ ? &*ends_ : nullptr);
    if (kept && record.cut == 0 && record.a == a && record.b == b) continue;
    leaf.used &= ~(1U << lane);
    if (kept) records.push_back(record);
  }
  if (leaf.used != used) leaves_.push_back({number, used});
}

}  // namespace penumbra::volumes
