// SPDX-License-Identifier: Apache-2.0
// Removes zero-area and duplicate triangles; a triangle with vertices of collinear triangles on its edges is split into
// fans. Not from a paper.

#include "mesh/edge_graph.hpp"
#include "repair/steps.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace penumbra::repair {
namespace {

void add(TriangleSoup& to, const TriangleSoup& from, std::size_t t, const Triangle& corners) {
  to.triangles.push_back(corners);
  to.object.push_back(from.object[t]);
  to.source_face.push_back(from.source_face[t]);
}

/// The vertices that collinear triangles put on edges.
class Subdivision {
 public:
  Subdivision(const TriangleSoup& soup, const EdgeGraph& graph) : graph_(graph) {
    const auto before = [&](std::uint32_t a, std::uint32_t b) {  // along a line, the order of coordinates is the order
                                                                 // of points
      const glm::dvec3 &p = soup.positions[a], &q = soup.positions[b];
      return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
    };
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      if (graph.kind[t] != TriangleKind::collinear) continue;
      Triangle corners = graph.corners(soup.triangles[t]);
      std::ranges::sort(corners, before);
      middle_.emplace(edge(corners[0], corners[2]), corners[1]);  // the first triangle's, if there are several
    }
  }

  [[nodiscard]] bool empty() const { return middle_.empty(); }

  /// Returns the vertices to insert between a and b, in order: those that lead to an edge which another triangle has.
  [[nodiscard]] std::vector<std::uint32_t> between(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> inserted;
    bool used = false;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{a, b}};
    while (!stack.empty()) {
      const auto [from, to] = stack.back();
      stack.pop_back();
      const auto found = middle_.find(edge(from, to));
      if (found != middle_.end()) {
        stack.emplace_back(found->second, to);
        stack.emplace_back(from, found->second);
        continue;
      }
      used = used || has_proper(edge(from, to));
      if (to != b) inserted.push_back(to);
    }
    if (inserted.empty() || !used) return {};
    return inserted;
  }

 private:
  [[nodiscard]] static Edge edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
  [[nodiscard]] bool has_proper(const Edge& edge) const {
    const auto found = std::ranges::lower_bound(graph_.edges, edge);
    if (found == graph_.edges.end() || *found != edge) return false;
    return std::ranges::any_of(graph_.around(static_cast<std::uint32_t>(found - graph_.edges.begin())),
                               [&](const Incidence& i) { return graph_.kind[i.triangle] == TriangleKind::proper; });
  }

  const EdgeGraph& graph_;
  std::map<Edge, std::uint32_t> middle_;
};

/// Splits a triangle with vertices on its edges into triangles with area: a fan over the first edge that has such
/// vertices, and fans over the other two from its first and last vertex.
std::vector<Triangle> split(const Triangle& corners, const Subdivision& subdivision) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
    const std::vector<std::uint32_t> on_ab = subdivision.between(a, b);
    if (on_ab.empty()) continue;
    std::vector<Triangle> pieces;
    const auto fan = [&](std::uint32_t apex, std::uint32_t from, const std::vector<std::uint32_t>& on,
                         std::uint32_t to) {
      for (const std::uint32_t v : on) pieces.push_back({apex, std::exchange(from, v), v});
      pieces.push_back({apex, from, to});
    };
    fan(on_ab.front(), c, subdivision.between(c, a), a);
    for (std::size_t k = 0; k + 1 < on_ab.size(); ++k) pieces.push_back({c, on_ab[k], on_ab[k + 1]});
    fan(on_ab.back(), b, subdivision.between(b, c), c);
    return pieces;
  }
  return {};
}

bool is_even(const Triangle& t) {
  return (t[0] < t[1]) == ((t[1] < t[2]) == (t[0] < t[2]));
}

struct WoundTriangle {
  Triangle sorted;
  bool even;  // winding: an even permutation of the sorted vertices
  std::uint32_t triangle;

  friend auto operator<=>(const WoundTriangle&, const WoundTriangle&) = default;
};

class Duplicates {
 public:
  Duplicates(const TriangleSoup& soup, const EdgeGraph& graph)
      : graph_(graph), keep_(soup.triangles.size(), true), triangles_at_(graph.edges.size()) {
    for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
      triangles_at_[edge] = graph.around(edge).size();
    }
    std::vector<WoundTriangle> faces;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      Triangle corners = graph.corners(soup.triangles[t]);
      const bool even = is_even(corners);
      std::ranges::sort(corners);
      faces.push_back({corners, even, t});
    }
    std::ranges::sort(faces);
    for (std::size_t i = 1; i < faces.size(); ++i) {
      if (faces[i].sorted != faces[i - 1].sorted) continue;
      if (faces[i].even == faces[i - 1].even) {
        remove(faces[i].triangle);
      } else {  // pairs the first triangle of each winding; odd ones come first
        std::size_t first = i - 1;
        while (first > 0 && faces[first - 1].sorted == faces[i].sorted) --first;
        pairs_.emplace_back(faces[first].triangle, faces[i].triangle);
      }
    }
  }

  /// Returns which triangles remain. Repeats until nothing changes, since a removed triangle may leave its neighbours'
  /// edges with an odd number of triangles.
  std::vector<bool> kept() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [s, t] : pairs_) {
        if (!keep_[s] || !keep_[t]) continue;
        const auto& edges = graph_.triangle_edges[t];
        if (std::ranges::none_of(edges, [&](std::uint32_t e) { return triangles_at_[e] % 2 == 1; })) continue;
        remove(std::max(s, t));
        changed = true;
      }
    }
    return keep_;
  }

 private:
  void remove(std::uint32_t t) {
    keep_[t] = false;
    for (const std::uint32_t edge : graph_.triangle_edges[t]) --triangles_at_[edge];
  }

  const EdgeGraph& graph_;
  std::vector<bool> keep_;
  std::vector<std::size_t> triangles_at_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

TriangleSoup remove_empty_triangles(const TriangleSoup& soup, double weld, RepairRecord& record) {
  const EdgeGraph graph = build_edge_graph({soup.positions, soup.triangles}, weld);
  const Subdivision subdivision(soup, graph);
  TriangleSoup repaired{soup.positions, {}, {}, {}};
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (graph.kind[t] != TriangleKind::proper) {
      ++record[graph.kind[t] == TriangleKind::repeated ? RepairKind::repeated : RepairKind::collinear];
      continue;
    }
    std::vector<Triangle> pieces;
    if (!subdivision.empty()) pieces = split(graph.corners(soup.triangles[t]), subdivision);
    if (pieces.empty()) {
      add(repaired, soup, t, soup.triangles[t]);
      continue;
    }
    ++record[RepairKind::split_face];
    for (const Triangle& piece : pieces) add(repaired, soup, t, piece);
  }
  return repaired;
}

TriangleSoup remove_duplicates(const TriangleSoup& soup, double weld, RepairRecord& record) {
  const EdgeGraph graph = build_edge_graph({soup.positions, soup.triangles}, weld);
  const std::vector<bool> keep = Duplicates(soup, graph).kept();
  TriangleSoup repaired{soup.positions, {}, {}, {}};
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (keep[t]) {
      add(repaired, soup, t, soup.triangles[t]);
    } else {
      ++record[RepairKind::duplicate];
    }
  }
  return repaired;
}

TriangleSoup without_unused_positions(const TriangleSoup& soup) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(soup.positions.size(), kUnused);
  TriangleSoup compact{{}, soup.triangles, soup.object, soup.source_face};
  for (Triangle& triangle : compact.triangles) {
    for (std::uint32_t& i : triangle) {
      if (number[i] == kUnused) {
        number[i] = static_cast<std::uint32_t>(compact.positions.size());
        compact.positions.push_back(soup.positions[i]);
      }
      i = number[i];
    }
  }
  return compact;
}

}  // namespace penumbra::repair
