// SPDX-License-Identifier: Apache-2.0
// Collects the signed edges of back-projected occluders, merged where triangles share them (Laine et al. 2005; any
// soup: docs/signed-crossings.md).

#include "areas/occluder_edges.hpp"

#include "areas/sweep_edges.hpp"
#include "mesh/predicates.hpp"
#include "mesh/sorted_sides.hpp"
#include "visibility/pair_truth.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace penumbra::areas {

using visibility::TriangleTree;

WeldedScene welded(const visibility::SceneFloats& scene, const TriangleTree& tree) {
  return {&scene, &tree, mesh::merge_equal(scene.positions)};
}

OccluderEdges::OccluderEdges(const WeldedScene& scene, const visibility::Light& light, const Receiver& receiver,
                             const BackProjection& projection, const LightShaft& shaft)
    : scene_(scene), light_(light), receiver_(receiver), projection_(projection), shaft_(shaft) {
  for_each_candidate([&](std::uint32_t triangle) { add_triangle(triangle); });
  merge_uses();
}

template <typename Visit>
void OccluderEdges::for_each_candidate(Visit&& visit) const {
  std::vector<std::uint32_t> stack;
  if (!scene_.tree->nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const TriangleTree::Node& node = scene_.tree->nodes[stack.back()];
    stack.pop_back();
    for (const TriangleTree::Child& child : node) {
      if (child.reference == TriangleTree::kNoChild || shaft_.misses(child.lower, child.upper)) continue;
      if ((child.reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(child.reference);
        continue;
      }
      for (const std::uint32_t triangle : scene_.tree->leaves[child.reference & ~TriangleTree::kLeafBit]) {
        if (triangle != TriangleTree::kNoTriangle) visit(triangle);
      }
    }
  }
}

void OccluderEdges::add_triangle(std::uint32_t triangle) {
  if (!may_occlude(*scene_.scene, light_, receiver_.carrier, triangle)) return;
  const std::array<glm::vec3, 3> corners = scene_.scene->corners(triangle);
  const std::array<LightShaft::Sides, 3> sides = {shaft_.sides_of(corners[0]), shaft_.sides_of(corners[1]),
                                                  shaft_.sides_of(corners[2])};
  if ((sides[0].outside & sides[1].outside & sides[2].outside) != 0) return;
  ++triangles_;
  int turn = static_cast<int>(mesh::side_of_plane(corners[0], corners[1], corners[2], receiver_.p));
  if (turn == 0) return;  // seen edge-on: hides nothing
  if (projection_.mirrored()) turn = -turn;

  const unsigned inside = sides[0].inside & sides[1].inside & sides[2].inside;
  // The planes along which a cut leaves an edge (cut_triangle).
  constexpr unsigned kCutting = bit_of(ClipPlane::light) | bit_of(ClipPlane::bottom);
  if ((inside & kCutting) != kCutting && !cut_triangle(corners, turn)) return;
  const visibility::Triangle& t = scene_.scene->triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t from = scene_.corner[t[i]], to = scene_.corner[t[(i + 1) % 3]];
    uses_.push_back(from < to ? EdgeUse{from, to, turn} : EdgeUse{to, from, -turn});
  }
}

bool OccluderEdges::cut_triangle(const std::array<glm::vec3, 3>& corners, int turn) {
  Polygon polygon;
  for (const glm::vec3& corner : corners) polygon.push_back(projection_.project(corner));
  if (turn < 0) std::swap(polygon[1], polygon[2]);
  if (std::ranges::none_of(polygon, [&](const auto& q) { return projection_.height(ClipPlane::light, q) > 0; }))
    return false;
  std::optional<ProjectiveEdge> cut;
  for (const ClipPlane plane : {ClipPlane::light, ClipPlane::left, ClipPlane::right, ClipPlane::bottom}) {
    polygon = projection_.clip_polygon(polygon, plane, cut);
    if (!cut || (plane != ClipPlane::light && plane != ClipPlane::bottom)) continue;
    if (auto edge = projection_.clip_edge(*cut, kAllClipPlanes & ~bit_of(plane))) cuts_.push_back(std::move(*edge));
  }
  return true;
}

void OccluderEdges::merge_uses() {
  std::ranges::sort(
      uses_, [](const EdgeUse& a, const EdgeUse& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < uses_.size();) {
    EdgeUse sum = uses_[i];
    for (++i; i < uses_.size() && uses_[i].low == sum.low && uses_[i].high == sum.high; ++i)
      sum.count += uses_[i].count;
    if (sum.count != 0) uses_[kept++] = sum;
  }
  uses_.resize(kept);
}

template <typename Number>
void OccluderEdges::append_to(std::vector<SweepEdge<Number>>& edges) const {
  const auto add = [&](const ProjectiveEdge& edge, int count) {
    const auto& [a, b] = edge;
    add_edge<Number>(edges, {ratio_of<Number>(a.s, a.w), ratio_of<Number>(a.t, a.w), ratio_of<Number>(b.s, b.w),
                             ratio_of<Number>(b.t, b.w), count, 0});
  };
  for (const EdgeUse& use : uses_) {
    const glm::vec3 &low = scene_.scene->positions[use.low], &high = scene_.scene->positions[use.high];
    const LightShaft::Sides a = shaft_.sides_of(low), b = shaft_.sides_of(high);
    if ((a.outside & b.outside) != 0) continue;
    const ProjectiveEdge whole{projection_.project(low), projection_.project(high)};
    if (const auto edge = projection_.clip_edge(whole, kAllClipPlanes & ~(a.inside & b.inside))) add(*edge, use.count);
  }
  for (const ProjectiveEdge& cut : cuts_) add(cut, 1);
}

template void OccluderEdges::append_to<double>(std::vector<SweepEdge<double>>&) const;
template void OccluderEdges::append_to<mpq_class>(std::vector<SweepEdge<mpq_class>>&) const;

}  // namespace penumbra::areas
