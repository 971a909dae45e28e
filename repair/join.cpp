// SPDX-License-Identifier: Apache-2.0
// Pairs the triangles around non-manifold edges by their order around the edge, with exact predicates. Not from a
// paper.

#include "base/assert.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"
#include "repair/steps.hpp"
#include "mesh/union_find.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace penumbra::repair {
namespace {

using mesh::find_root;
using mesh::Side;
using mesh::side_of_plane;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;  // CGAL's kernel only (LGPL)

constexpr std::uint32_t kNone = 0xffffffffu;

/// Returns whether c and d are on the same side of the line through a and b, all four on one plane.
bool same_half_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const auto at = [](const glm::dvec3& p) { return Kernel::Point_3(p.x, p.y, p.z); };
  return CGAL::coplanar_orientation(at(a), at(b), at(c), at(d)) == CGAL::POSITIVE;
}

/// A triangle at an edge of more than two triangles, with its place around the edge.
struct Spoke {
  std::uint32_t half_edge;  // 3 · triangle + corner
  std::uint32_t apex;
  bool opens;  // the solid begins here, counter-clockwise around the edge as seen against its direction
  int half = 0;
};

class Joiner {
 public:
  Joiner(const TriangleSoup& soup, const EdgeGraph& graph, RepairRecord& record)
      : soup_(soup),
        graph_(graph),
        record_(record),
        turn_(soup.triangles.size(), false),
        mate_(3 * soup.triangles.size(), kNone) {}

  TriangleSoup joined() {
    wind_patches();
    link_edges();
    find_fans();
    while (detach_crowded()) find_fans();
    count();
    return result();
  }

 private:
  [[nodiscard]] std::uint32_t half_edge(std::uint32_t t, std::uint32_t edge) const {
    const auto& edges = graph_.triangle_edges[t];
    return 3 * t + static_cast<std::uint32_t>(std::ranges::find(edges, edge) - edges.begin());
  }
  [[nodiscard]] bool reversed(const Incidence& i) const { return i.reversed != turn_[i.triangle]; }
  [[nodiscard]] std::uint32_t position(std::uint32_t corner) const { return soup_.triangles[corner / 3][corner % 3]; }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t corner) const { return graph_.vertex[position(corner)]; }
  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  /// Returns the half-edge's corners at the edge's two ends, lower vertex first.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> ends(std::uint32_t half_edge) const {
    const std::uint32_t other = next(half_edge);
    return vertex(half_edge) < vertex(other) ? std::pair(half_edge, other) : std::pair(other, half_edge);
  }

  /// Winds each triangle consistently with the neighbour, across an edge of two triangles, from which it was first
  /// reached; of each patch the minority is reversed.
  void wind_patches() {
    std::vector<bool> seen(turn_.size(), false);
    std::vector<std::uint32_t> patch;
    for (std::uint32_t seed = 0; seed < turn_.size(); ++seed) {
      if (seen[seed]) continue;
      patch.assign(1, seed);
      seen[seed] = true;
      std::size_t turned = 0;
      for (std::size_t i = 0; i < patch.size(); ++i) {
        for (const std::uint32_t edge : graph_.triangle_edges[patch[i]]) {
          const auto around = graph_.around(edge);
          if (around.size() != 2) continue;
          const std::uint32_t other = around[around[0].triangle == patch[i] ? 1 : 0].triangle;
          if (seen[other]) continue;
          seen[other] = true;
          turn_[other] = turn_[patch[i]] != (around[0].reversed == around[1].reversed);
          turned += turn_[other] ? 1 : 0;
          patch.push_back(other);
        }
      }
      if (2 * turned <= patch.size()) continue;
      for (const std::uint32_t t : patch) turn_[t] = !turn_[t];
    }
  }

  void link(std::uint32_t g, std::uint32_t h) {
    mate_[g] = h;
    mate_[h] = g;
  }

  void link_edges() {
    std::uint64_t twisted = 0;
    for (std::uint32_t edge = 0; edge < graph_.edges.size(); ++edge) {
      const auto around = graph_.around(edge);
      if (around.size() > 2) {
        link_around(edge);
      } else if (around.size() == 2 && reversed(around[0]) == reversed(around[1])) {
        ++twisted;
      } else if (around.size() == 2) {
        link(half_edge(around[0].triangle, edge), half_edge(around[1].triangle, edge));
      }
    }
    if (twisted > 0) {
      record_.left.push_back(fmt::format(
          "{} edges stay cut open: no winding of their surface is consistent there (as on a Möbius band)", twisted));
    }
  }

  /// Sorts the triangles around the edge and joins those that bound a solid, like brackets: a triangle whose back faces
  /// counter-clockwise opens, one whose back faces clockwise closes. At equal angles, closing comes first: the two
  /// sides of a plate are joined to the next triangles on their sides, and the wall between two solids to the triangles
  /// of each solid.
  void link_around(std::uint32_t edge) {
    const glm::dvec3 &a = soup_.positions[graph_.edges[edge].a], &b = soup_.positions[graph_.edges[edge].b];
    std::vector<Spoke> spokes;
    for (const Incidence& i : graph_.around(edge)) {
      spokes.push_back({half_edge(i.triangle, edge), i.apex, reversed(i)});
    }
    const glm::dvec3& reference = soup_.positions[spokes[0].apex];
    for (Spoke& spoke : spokes) {
      const glm::dvec3& apex = soup_.positions[spoke.apex];
      const Side side = side_of_plane(a, b, reference, apex);
      if (side == Side::on) {
        spoke.half = same_half_plane(a, b, reference, apex) ? 0 : 2;
      } else {
        spoke.half = side == Side::front ? 1 : 3;
      }
    }
    std::ranges::sort(spokes, [&](const Spoke& s, const Spoke& t) {
      if (s.half != t.half) return s.half < t.half;
      const Side side = side_of_plane(a, b, soup_.positions[s.apex], soup_.positions[t.apex]);
      if (side != Side::on) return side == Side::front;
      return std::tie(s.opens, s.half_edge) < std::tie(t.opens, t.half_edge);
    });
    std::vector<std::uint32_t> open;
    // in the second round, remaining opening triangles meet remaining closing ones
    for (int round = 0; round < 2; ++round) {
      for (const Spoke& spoke : spokes) {
        if (mate_[spoke.half_edge] != kNone) continue;
        if (spoke.opens && round == 0) open.push_back(spoke.half_edge);
        if (spoke.opens || open.empty()) continue;
        link(open.back(), spoke.half_edge);
        open.pop_back();
      }
    }
  }

  void find_fans() {
    std::vector<std::uint32_t> parent(mate_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto unite = [&](std::uint32_t a, std::uint32_t b) {
      a = find_root(parent, a);
      b = find_root(parent, b);
      parent[std::max(a, b)] = std::min(a, b);
    };
    for (std::uint32_t h = 0; h < mate_.size(); ++h) {
      if (mate_[h] == kNone || mate_[h] < h) continue;
      unite(ends(h).first, ends(mate_[h]).first);
      unite(ends(h).second, ends(mate_[h]).second);
    }
    fan_.resize(mate_.size());
    fans_ = 0;
    for (std::uint32_t corner = 0; corner < fan_.size(); ++corner) {
      const std::uint32_t root = find_root(parent, corner);
      fan_[corner] = root == corner ? fans_++ : fan_[root];
    }
  }

  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> fans_at_ends(std::uint32_t half_edge) const {
    return {fan_[ends(half_edge).first], fan_[ends(half_edge).second]};
  }

  /// Calls `visit` with each set of half-edges at the edge that have the same key, if the set is more than one joined
  /// pair. For such a set, with the pair of indices at the edge's ends as key, indices alone do not tell which
  /// triangles are joined.
  template <typename Key, typename Visit>
  void for_each_crowd(std::uint32_t edge, Key key, Visit visit) const {
    if (graph_.around(edge).size() < 2) return;
    std::vector<std::uint32_t> here;
    for (const Incidence& i : graph_.around(edge)) here.push_back(half_edge(i.triangle, edge));
    std::ranges::stable_sort(here, {}, key);
    for (std::size_t first = 0, last = 0; first < here.size(); first = last) {
      while (last < here.size() && key(here[last]) == key(here[first])) ++last;
      const auto crowd = std::span(here).subspan(first, last - first);
      if (crowd.size() > 2 || (crowd.size() == 2 && mate_[crowd[0]] != crowd[1])) visit(crowd);
    }
  }

  /// Finds edges along which a surface touches itself while its corners at both ends are joined (one fan each), which
  /// indices cannot represent; there it cuts off all triangles but one pair, each one separately. Returns whether there
  /// was such an edge.
  bool detach_crowded() {
    std::set<std::uint32_t> detached;
    const auto detach_all_but_a_pair = [&](std::span<const std::uint32_t> crowd) {
      const auto joined = std::ranges::find_if(crowd, [&](std::uint32_t h) { return mate_[h] != kNone; });
      const std::uint32_t keep = joined == crowd.end() ? crowd[0] : *joined;
      for (const std::uint32_t h : crowd) {
        if (h != keep && h != mate_[keep]) detached.insert(h / 3);
      }
    };
    for (std::uint32_t edge = 0; edge < graph_.edges.size(); ++edge) {
      for_each_crowd(
          edge, [&](std::uint32_t h) { return fans_at_ends(h); }, detach_all_but_a_pair);
    }
    for (const std::uint32_t t : detached) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (mate_[h] != kNone) mate_[std::exchange(mate_[h], kNone)] = kNone;
      }
    }
    detached_ += detached.size();
    return !detached.empty();
  }

  /// Counts the changes of indices between the soup and the result.
  void count() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> uses;  // (position, fan)
    for (std::uint32_t corner = 0; corner < fan_.size(); ++corner) uses.emplace(position(corner), fan_[corner]);
    std::set<std::uint32_t> used;
    for (const auto& [index, fan] : uses) {
      if (used.insert(index).second && soup_.positions[index] != soup_.positions[graph_.vertex[index]]) {
        ++record_[RepairKind::moved];
      }
    }
    // Each fan becomes one position: a second position used by a fan is a merge, a second use of a position is a split.
    record_[RepairKind::merged] += uses.size() - fans_;
    record_[RepairKind::split_vertex] += uses.size() - used.size();
    record_[RepairKind::unused] += soup_.positions.size() - used.size();
    record_[RepairKind::turned] += static_cast<std::uint64_t>(std::ranges::count(turn_, true));
    for (std::uint32_t h = 0; h < mate_.size(); ++h) {
      if (mate_[h] != kNone && mate_[h] > h && positions_at_ends(h) != positions_at_ends(mate_[h])) {
        ++record_[RepairKind::stitched];
      }
    }
    for (std::uint32_t edge = 0; edge < graph_.edges.size(); ++edge) {
      bool crowded = false;
      for_each_crowd(
          edge, [&](std::uint32_t h) { return positions_at_ends(h); }, [&](const auto&) { crowded = true; });
      record_[RepairKind::split_edge] += crowded ? 1 : 0;
    }
    if (detached_ > 0) {
      record_.left.push_back(
          fmt::format("{} triangles stay cut off: their surface touches itself along single edges", detached_));
    }
  }

  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> positions_at_ends(std::uint32_t half_edge) const {
    return {position(ends(half_edge).first), position(ends(half_edge).second)};
  }

  [[nodiscard]] TriangleSoup result() const {
    TriangleSoup repaired{{}, {}, soup_.object, soup_.source_face};
    repaired.positions.resize(fans_);
    for (std::uint32_t t = 0; t < turn_.size(); ++t) {
      for (std::uint32_t i = 3 * t; i < 3 * t + 3; ++i) repaired.positions[fan_[i]] = soup_.positions[vertex(i)];
      const std::size_t first = 3 * std::size_t{t};
      Triangle corners = {fan_[first], fan_[first + 1], fan_[first + 2]};
      if (turn_[t]) std::swap(corners[1], corners[2]);
      repaired.triangles.push_back(corners);
    }
    return repaired;
  }

  const TriangleSoup& soup_;
  const EdgeGraph& graph_;
  RepairRecord& record_;
  std::vector<bool> turn_;
  std::vector<std::uint32_t> mate_;  // for each half-edge, the one that it is joined to
  std::vector<std::uint32_t> fan_;   // fan of each corner
  std::uint32_t fans_ = 0;
  std::uint64_t detached_ = 0;
};

}  // namespace

TriangleSoup join(const TriangleSoup& soup, double weld, RepairRecord& record) {
  const EdgeGraph graph = build_edge_graph({soup.positions, soup.triangles}, weld);
  PENUMBRA_ASSERT(std::ranges::all_of(graph.kind, [](TriangleKind kind) { return kind == TriangleKind::proper; }),
                  "a triangle without area is left among {}", graph.kind.size());
  return Joiner(soup, graph, record).joined();
}

}  // namespace penumbra::repair
