// SPDX-License-Identifier: Apache-2.0
// Watertightness of a soup by its signed boundary; here is why a test at each vertex suffices. The signed boundary is a
// sum of m_e [a_e → b_e]. Different lines share at most a point, so the boundary is zero exactly if its part on each
// line is. That part has, along the line, a piecewise constant multiplicity that is zero far away, so it is zero
// everywhere exactly if it never jumps; at a point v it jumps by the sum of ±m_e over the edges on this line that end
// (+) or begin (−) there. So: at each vertex, group the edges by the line through the vertex that they lie on, and each
// group must sum to zero. Triangles without area need no special case: the three edges of a collinear one cancel on
// their line by themselves.

#include "mesh/diagnosis/winding.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>

namespace penumbra::mesh {
namespace {

/// An edge of the signed boundary, seen from one of its ends.
struct End {
  std::uint32_t other = 0;  // the far end
  int sum = 0;              // m_e, negative where the edge begins
};

/// The ends of boundary edges, grouped by vertex.
struct Ends {
  std::vector<std::uint32_t> first;  // begin of each vertex in `ends`, and the end of the last
  std::vector<End> ends;
};

int signed_sum(const EdgeGraph& graph, std::uint32_t edge, const std::vector<bool>& turned) {
  int sum = 0;
  for (const Incidence& incidence : graph.around(edge)) {
    const bool turn = !turned.empty() && turned[incidence.triangle];
    sum += incidence.reversed != turn ? -1 : 1;
  }
  return sum;
}

Ends boundary_ends(const EdgeGraph& graph, const std::vector<bool>& turned) {
  std::vector<int> sums(graph.edges.size());
  for_each_index(sums.size(),
                 [&](std::size_t edge) { sums[edge] = signed_sum(graph, static_cast<std::uint32_t>(edge), turned); });
  Ends all;
  all.first.resize(graph.vertex.size() + 2);  // offset by two, so that after filling each entry is its group's begin
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i] != 0) ++all.first[graph.edges[i].a + 2], ++all.first[graph.edges[i].b + 2];
  }
  for (std::size_t i = 2; i < all.first.size(); ++i) all.first[i] += all.first[i - 1];
  all.ends.resize(all.first.back());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i] == 0) continue;
    const auto [a, b] = graph.edges[i];
    all.ends[all.first[a + 1]++] = {b, -sums[i]};
    all.ends[all.first[b + 1]++] = {a, sums[i]};
  }
  all.first.pop_back();
  return all;
}

/// Returns whether the edges that end at v cancel on each line through v.
bool cancels(std::span<const glm::dvec3> positions, std::uint32_t v, std::span<End> ends) {
  const auto compare = [&](const End& e, const End& f) {
    return compare_lines(positions[v], positions[e.other], positions[f.other]);
  };
  if (ends.size() == 1 || (ends.size() == 2 && compare(ends[0], ends[1]) != 0)) return ends.empty();
  std::ranges::sort(ends, [&](const End& e, const End& f) { return compare(e, f) < 0; });
  int sum = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    sum += ends[i].sum;
    const bool last = i + 1 == ends.size() || compare(ends[i], ends[i + 1]) != 0;
    if (last && sum != 0) return false;
  }
  return true;
}

/// Returns a triangle's sorted corners: the tie breaker that decides a patch's winding if turned and unturned triangles
/// are equally many.
std::array<std::array<double, 3>, 3> sorted_corners(const MeshView& mesh, const Triangle& corners) {
  std::array<std::array<double, 3>, 3> sorted;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& p = mesh.positions[corners[i]];
    sorted[i] = {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // −0 becomes 0
  }
  std::ranges::sort(sorted);
  return sorted;
}

/// A patch of neighbours, all wound like its first triangle except those in `turned`; `orientable` is false if no such
/// winding exists.
struct Patch {
  std::vector<std::uint32_t> triangles;
  bool orientable = true;
};

Patch grow_patch(const EdgeGraph& graph, std::uint32_t seed, std::vector<bool>& seen, std::vector<bool>& turned) {
  Patch patch{{seed}};
  seen[seed] = true;
  for (std::size_t next = 0; next < patch.triangles.size(); ++next) {
    const std::uint32_t t = patch.triangles[next];
    for (const std::uint32_t edge : graph.triangle_edges[t]) {
      const auto around = graph.around(edge);
      if (around.size() != 2 || around[0].apex == around[1].apex) continue;
      const std::uint32_t u = around[around[0].triangle == t ? 1 : 0].triangle;
      const bool turn = turned[t] != (around[0].reversed == around[1].reversed);
      if (!seen[u]) {
        seen[u] = true;
        turned[u] = turn;
        patch.triangles.push_back(u);
      } else if (turned[u] != turn) {
        patch.orientable = false;
      }
    }
  }
  return patch;
}

/// Returns whether more than half of the patch's triangles are turned, or exactly half of them including the one whose
/// sorted corners come first.
bool should_turn_back(const MeshView& mesh, const EdgeGraph& graph, const Patch& patch,
                      const std::vector<bool>& turned) {
  const auto count =
      static_cast<std::size_t>(std::ranges::count_if(patch.triangles, [&](auto t) { return turned[t]; }));
  if (2 * count != patch.triangles.size()) return 2 * count > patch.triangles.size();
  const auto first = std::ranges::min_element(patch.triangles, {}, [&](std::uint32_t t) {
    return std::pair(sorted_corners(mesh, graph.corners(mesh.triangles[t])), t);
  });
  return turned[*first];
}

}  // namespace

std::vector<bool> turns_to_agree(const MeshView& mesh, const EdgeGraph& graph) {
  std::vector<bool> seen(mesh.triangles.size()), turned(mesh.triangles.size());
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed] || graph.kind[seed] == TriangleKind::repeated) continue;
    const Patch patch = grow_patch(graph, seed, seen, turned);
    if (!patch.orientable) {
      for (const std::uint32_t t : patch.triangles) turned[t] = false;
    } else if (should_turn_back(mesh, graph, patch, turned)) {
      for (const std::uint32_t t : patch.triangles) turned[t] = !turned[t];
    }
  }
  return turned;
}

bool is_closed(const MeshView& mesh, const EdgeGraph& graph, const std::vector<bool>& turned) {
  PENUMBRA_ASSERT(turned.empty() || turned.size() == mesh.triangles.size(), "{} turns", turned.size());
  Ends all = boundary_ends(graph, turned);
  std::atomic<bool> closed = true;
  for_each_index(graph.vertex.size(), [&](std::size_t v) {
    const std::span ends = std::span(all.ends).subspan(all.first[v], all.first[v + 1] - all.first[v]);
    if (!ends.empty() && closed && !cancels(mesh.positions, static_cast<std::uint32_t>(v), ends)) closed = false;
  });
  return closed;
}

}  // namespace penumbra::mesh
