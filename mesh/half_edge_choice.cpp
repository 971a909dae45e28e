// SPDX-License-Identifier: Apache-2.0
// Selects the triangles that a half-edge structure can hold, and orients them consistently. Not from a paper.

#include "mesh/half_edge_choice.hpp"

#include "mesh/union_find.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace penumbra::mesh {
namespace {

constexpr std::uint32_t kNotHeld = HeldTriangles::kNotHeld;

/// Returns the triangles with an area at an edge, if there are exactly two. Triangles without an area cast no shadow
/// and are never held, so they do not crowd an edge.
std::optional<std::array<Incidence, 2>> neighbours(const EdgeGraph& graph, std::uint32_t edge) {
  std::array<Incidence, 2> pair;
  std::size_t count = 0;
  for (const Incidence& incidence : graph.around(edge)) {
    if (graph.kind[incidence.triangle] != TriangleKind::proper) continue;
    if (count == 2) return std::nullopt;
    pair[count++] = incidence;
  }
  if (count < 2) return std::nullopt;
  return pair;
}

std::vector<bool> crowded_edges(const EdgeGraph& graph) {
  std::vector<bool> crowded(graph.edges.size());
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    crowded[edge] = std::ranges::count_if(graph.around(edge), [&](const Incidence& i) {
                      return graph.kind[i.triangle] == TriangleKind::proper;
                    }) > 2;
  }
  return crowded;
}

/// Winds triangles breadth first, from the lowest remaining one: every triangle is wound to agree with the neighbours
/// already held, and listed if they disagree.
class Winder {
 public:
  Winder(const EdgeGraph& graph, HeldTriangles& held)
      : graph_(graph), held_(held), seen_(graph.kind.size(), false), crowded_(crowded_edges(graph)) {}

  void wind_all() {
    for (std::uint32_t t = 0; t < graph_.kind.size(); ++t) {
      if (const auto why = unfit(t)) give_up(t, *why);
    }
    for (std::uint32_t t = 0; t < graph_.kind.size(); ++t) {
      if (!seen_[t]) wind_patch(t);
    }
    std::ranges::sort(held_.listed, {}, &ListedFace::triangle);
  }

 private:
  [[nodiscard]] std::optional<NotHeld> unfit(std::uint32_t t) const {
    if (graph_.kind[t] == TriangleKind::repeated) return NotHeld::repeated_vertex;
    if (graph_.kind[t] == TriangleKind::collinear) return NotHeld::collinear;
    const auto& edges = graph_.triangle_edges[t];
    if (std::ranges::any_of(edges, [&](std::uint32_t e) { return crowded_[e]; })) return NotHeld::crowded_edge;
    return std::nullopt;
  }

  void give_up(std::uint32_t t, NotHeld why) {
    seen_[t] = true;
    held_.listed.push_back({t, why});
  }

  void wind_patch(std::uint32_t seed) {
    std::vector<std::uint32_t> patch{seed};
    seen_[seed] = true;
    held_.patch[seed] = held_.patches;
    std::size_t turned = 0;
    for (std::size_t next = 0; next < patch.size(); ++next) {
      for (const std::uint32_t edge : graph_.triangle_edges[patch[next]]) {
        const auto pair = neighbours(graph_, edge);
        if (!pair) continue;
        const std::uint32_t other = (*pair)[(*pair)[0].triangle == patch[next] ? 1 : 0].triangle;
        if (seen_[other]) continue;
        const std::optional<bool> turn = wanted_turn(other);
        if (!turn) {
          give_up(other, NotHeld::not_orientable);
          continue;
        }
        seen_[other] = true;
        held_.patch[other] = held_.patches;
        held_.turn[other] = *turn;
        turned += *turn ? 1 : 0;
        patch.push_back(other);
      }
    }
    if (2 * turned > patch.size()) {
      for (const std::uint32_t t : patch) held_.turn[t] = !held_.turn[t];
    }
    ++held_.patches;
  }

  /// Returns whether the held neighbours of t require it to be turned; nullopt if they disagree.
  [[nodiscard]] std::optional<bool> wanted_turn(std::uint32_t t) const {
    std::optional<bool> wanted;
    for (const std::uint32_t edge : graph_.triangle_edges[t]) {
      const auto pair = neighbours(graph_, edge);
      if (!pair) continue;
      const std::uint32_t other = (*pair)[(*pair)[0].triangle == t ? 1 : 0].triangle;
      if (held_.patch[other] == kNotHeld) continue;
      const bool same_direction = (*pair)[0].reversed == (*pair)[1].reversed;
      const bool turn = held_.turn[other] != same_direction;
      if (wanted && *wanted != turn) return std::nullopt;
      wanted = turn;
    }
    return wanted;
  }

  const EdgeGraph& graph_;
  HeldTriangles& held_;
  std::vector<bool> seen_, crowded_;
};

}  // namespace

HeldTriangles choose_held(const EdgeGraph& graph) {
  HeldTriangles held;
  held.patch.assign(graph.kind.size(), kNotHeld);
  held.turn.assign(graph.kind.size(), false);
  Winder(graph, held).wind_all();
  return held;
}

HeldFans find_held_fans(const MeshView& mesh, const EdgeGraph& graph, const HeldTriangles& held) {
  std::vector<std::uint32_t> parent(3 * mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto corner_at = [&](std::uint32_t t, std::uint32_t point) {
    const Triangle corners = graph.corners(mesh.triangles[t]);
    const auto corner = std::ranges::find(corners, point) - corners.begin();
    return 3 * t + static_cast<std::uint32_t>(corner);
  };
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const auto pair = neighbours(graph, edge);
    if (!pair) continue;
    const auto [s, t] = std::pair((*pair)[0].triangle, (*pair)[1].triangle);
    if (held.patch[s] == kNotHeld || held.patch[t] == kNotHeld) continue;
    for (const std::uint32_t point : {graph.edges[edge].a, graph.edges[edge].b}) {
      const std::uint32_t a = find_root(parent, corner_at(s, point)), b = find_root(parent, corner_at(t, point));
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  HeldFans fans;
  fans.of_corner.assign(parent.size(), kNotHeld);
  for (std::uint32_t corner = 0; corner < parent.size(); ++corner) {
    if (held.patch[corner / 3] == kNotHeld) continue;
    const std::uint32_t root = find_root(parent, corner);
    if (root == corner) {
      fans.of_corner[corner] = static_cast<std::uint32_t>(fans.point.size());
      fans.point.push_back(graph.vertex[mesh.triangles[corner / 3][corner % 3]]);
    } else {
      fans.of_corner[corner] = fans.of_corner[root];
    }
  }
  return fans;
}

}  // namespace penumbra::mesh
