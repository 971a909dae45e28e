// SPDX-License-Identifier: Apache-2.0
// T-junctions: vertices exactly inside edges. Candidates come from a tree over the vertices, which each edge traverses
// as a segment (a long diagonal edge has a large box, but passes few vertices); the verdict is exact. The traversal
// errs only toward more candidates.
// Many vertices on one line with many edges on it would give a quadratic number of pairs. Therefore the vertices on the
// line of a crowded edge are found and sorted once, and every other edge on that line counts those between its ends by
// two binary searches.

#include "mesh/diagnosis/t_junctions.hpp"

#include "mesh/box_tree.hpp"
#include "mesh/diagnosis/defect_list.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::mesh {
namespace {

/// Tests which boxes a segment meets, by separating axes (Ericson 2005, Real-Time Collision Detection, 5.3.3).
/// Coordinates are within [−1, 1]. The answer "no" is certain: the box of the segment is compared exactly, and the
/// three cross products carry a bound on their error: with |T| ≤ 2 and e ≤ 1 each computed to within 2⁻⁵¹, and h to
/// within 2⁻⁵³ of itself, both sides of each comparison are off by less than 2⁻⁴⁸ (|h_j| + |h_k|), or 2⁻¹⁰⁰⁰ on
/// underflow.
class SegmentQuery {
 public:
  SegmentQuery(const glm::dvec3& a, const glm::dvec3& b)
      : middle_(0.5 * a + 0.5 * b), half_(0.5 * b - 0.5 * a), length_(glm::abs(half_)) {
    box_.include(a);
    box_.include(b);
  }

  bool reaches(const Box& box) const { return box_.meets(box) && line_reaches(box); }
  /// Tests the whole line that contains the segment; this needs three of the axes, and the same error bounds hold.
  bool line_reaches(const Box& box) const {
    const glm::dvec3 t = middle_ - (0.5 * box.lower + 0.5 * box.upper), e = 0.5 * box.upper - 0.5 * box.lower;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double reach = e[j] * length_[k] + e[k] * length_[j];
      if (std::abs(t[j] * half_[k] - t[k] * half_[j]) > reach + 0x1p-48 * (length_[j] + length_[k]) + 0x1p-1000) {
        return false;
      }
    }
    return true;
  }

 private:
  glm::dvec3 middle_, half_, length_;
  Box box_;
};

/// Returns a power of two that brings the largest coordinate to [0.5, 1): exact, except for underflow.
double scale_to_one(const MeshView& mesh, std::span<const std::uint32_t> vertices) {
  double largest = 0;
  for (const std::uint32_t v : vertices) {
    const glm::dvec3 p = glm::abs(mesh.positions[v]);
    largest = std::max({largest, p.x, p.y, p.z});
  }
  return largest > 0 ? std::ldexp(1.0, std::clamp(-1 - std::ilogb(largest), -1022, 1023)) : 1;
}

std::vector<std::uint32_t> used_vertices(const MeshView& mesh, const EdgeGraph& graph) {
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : graph.corners(triangle)) used[v] = true;
  }
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (used[v]) vertices.push_back(v);
  }
  return vertices;
}

/// Returns the first axis along which the edge's ends differ: positions on the edge's line are ordered by this
/// coordinate.
int telling_axis(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 2; ++i) {
    if (a[i] != b[i]) return i;
  }
  return 2;
}

bool strictly_between(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
  const int i = telling_axis(a, b);
  return std::min(a[i], b[i]) < p[i] && p[i] < std::max(a[i], b[i]);
}

/// An edge that contains more vertices than this is crowded.
constexpr std::size_t kCrowded = 32;

class Search {
 public:
  Search(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit)
      : mesh_(mesh),
        graph_(graph),
        list_limit_(list_limit),
        vertices_(used_vertices(mesh, graph)),
        scale_(scale_to_one(mesh, vertices_)),
        tree_(points()),
        found_(list_limit) {}

  Defect run(const Progress& progress) {
    Progress::Counter counter(progress, graph_.edges.size());
    // Searches in the order of the tree, so that successive searches visit the same memory; edges are sorted by a.
    for_each_index(vertices_.size(), [&](std::size_t i) {
      const std::uint32_t v = vertices_[tree_.order()[i]];
      auto edge = std::ranges::lower_bound(graph_.edges, Edge{v, 0});
      for (; edge != graph_.edges.end() && edge->a == v; ++edge) {
        search(static_cast<std::uint32_t>(edge - graph_.edges.begin()));
        counter.done_one();
      }
    });
    DefectList all(list_limit_);
    for (DefectList& list : found_) all.add_all(std::move(list));
    add_crowded(all);
    return std::move(all).finish(mesh_);
  }

 private:
  using Numbers = std::vector<std::uint32_t>;

  [[nodiscard]] glm::dvec3 scaled(std::uint32_t v) const { return scale_ * mesh_.positions[v]; }
  [[nodiscard]] std::vector<Box> points() const {
    std::vector<Box> points(vertices_.size());
    for_each_index(points.size(), [&](std::size_t i) { points[i].include(scaled(vertices_[i])); });
    return points;
  }
  [[nodiscard]] Numbers triangles_at(std::uint32_t edge) const {
    Numbers triangles;
    for (const Incidence& i : graph_.around(edge)) triangles.push_back(i.triangle);
    return triangles;
  }

  void search(std::uint32_t e) {
    const std::uint32_t a = graph_.edges[e].a, b = graph_.edges[e].b;
    const glm::dvec3 &at_a = mesh_.positions[a], &at_b = mesh_.positions[b];
    const SegmentQuery query(scaled(a), scaled(b));
    Numbers& inside = inside_.local();
    inside.clear();
    tree_.find([&](const Box& box) { return inside.size() <= kCrowded && query.reaches(box); },
               [&](std::uint32_t item) {
                 const std::uint32_t v = vertices_[item];
                 const glm::dvec3& p = mesh_.positions[v];
                 if (v == a || v == b || !strictly_between(at_a, at_b, p) || !collinear(at_a, at_b, p)) return;
                 inside.push_back(v);
               });
    if (inside.size() > kCrowded) return crowded_.local().push_back(e);
    if (inside.empty()) return;
    const Numbers triangles = triangles_at(e);
    for (const std::uint32_t v : inside) found_.local().add(triangles, std::array{v, a, b});
  }

  /// Adds edges in the order of their first triangles, so that the list is full soon and the remaining edges are only
  /// counted.
  void add_crowded(DefectList& all) {
    Numbers edges;
    for (const Numbers& some : crowded_) edges.insert(edges.end(), some.begin(), some.end());
    if (edges.empty()) return;
    std::ranges::sort(edges, {}, [&](std::uint32_t e) { return std::pair(graph_.around(e).front().triangle, e); });
    lines_at_.resize(mesh_.positions.size());
    for (const std::uint32_t e : edges) {
      const std::uint32_t a = graph_.edges[e].a, b = graph_.edges[e].b;
      const Numbers& line = lines_[line_through(a, b)];
      const int axis = telling_axis(mesh_.positions[a], mesh_.positions[b]);
      const auto place = [&](std::uint32_t v) { return mesh_.positions[v][axis]; };
      const double low = std::min(place(a), place(b)), high = std::max(place(a), place(b));
      const auto first = std::ranges::upper_bound(line, low, {}, place);
      const auto last = std::ranges::lower_bound(line, high, {}, place);
      const auto count = static_cast<std::size_t>(last - first);
      const Numbers triangles = triangles_at(e);
      if (!all.may_list(triangles.front())) {
        all.count(count);
        continue;
      }
      Numbers inside(first, last);
      const std::size_t listed = std::min(list_limit_, count);
      std::ranges::partial_sort(inside, inside.begin() + static_cast<std::ptrdiff_t>(listed));
      for (const std::uint32_t v : std::span(inside).first(listed)) all.add(triangles, std::array{v, a, b});
      all.count(count - listed);
    }
  }

  /// Returns the index in `lines_` of the line through two vertices: two vertices that lie on one known line lie on no
  /// other.
  std::size_t line_through(std::uint32_t a, std::uint32_t b) {
    const Numbers &at_a = lines_at_[a], &at_b = lines_at_[b];
    for (const std::uint32_t line : at_a) {
      if (std::ranges::find(at_b, line) != at_b.end()) return line;
    }
    const glm::dvec3 &from = mesh_.positions[a], &to = mesh_.positions[b];
    const SegmentQuery query(scaled(a), scaled(b));
    Numbers on_line;
    tree_.find([&](const Box& box) { return query.line_reaches(box); },
               [&](std::uint32_t item) {
                 if (collinear(from, to, mesh_.positions[vertices_[item]])) on_line.push_back(vertices_[item]);
               });
    const int axis = telling_axis(from, to);
    std::ranges::sort(on_line, {}, [&](std::uint32_t v) { return std::pair(mesh_.positions[v][axis], v); });
    for (const std::uint32_t v : on_line) lines_at_[v].push_back(static_cast<std::uint32_t>(lines_.size()));
    lines_.push_back(std::move(on_line));
    return lines_.size() - 1;
  }

  const MeshView& mesh_;
  const EdgeGraph& graph_;
  std::size_t list_limit_;
  Numbers vertices_;
  double scale_;
  BoxTree tree_;
  tbb::enumerable_thread_specific<DefectList> found_;
  tbb::enumerable_thread_specific<Numbers> inside_, crowded_;
  std::vector<Numbers> lines_;     ///< for each line of crowded edges, the vertices on it, in order along it
  std::vector<Numbers> lines_at_;  ///< for each vertex, the lines through it
};

}  // namespace

Defect find_t_junctions(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit,
                        const Progress& progress) {
  return Search(mesh, graph, list_limit).run(progress);
}

}  // namespace penumbra::mesh
