// Candidates by a tree over the vertices that each edge descends as a segment (a long diagonal edge has a large box,
// but passes few vertices); the verdict is exact. The descent errs only on the side of more candidates.

#include "mesh/diagnosis/t_junctions.hpp"

#include "mesh/box_tree.hpp"
#include "mesh/diagnosis/defect_list.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

namespace penumbra::mesh {
namespace {

/// A segment that asks which boxes it meets, by separating axes (Ericson 2005, Real-Time Collision Detection, 5.3.3).
/// Coordinates within [−1, 1]. "No" is certain: the box of the segment is compared exactly, and the three cross
/// products carry a bound on their error: with |T| ≤ 2 and e ≤ 1 each computed to within 2⁻⁵¹, and h to within
/// 2⁻⁵³ of itself, both sides of each comparison are off by less than 2⁻⁴⁸ (|h_j| + |h_k|), or 2⁻¹⁰⁰⁰ on underflow.
class SegmentQuery {
 public:
  SegmentQuery(const glm::dvec3& a, const glm::dvec3& b)
      : middle_(0.5 * a + 0.5 * b), half_(0.5 * b - 0.5 * a), length_(glm::abs(half_)) {
    box_.include(a);
    box_.include(b);
  }

  bool reaches(const Box& box) const {
    if (!box_.meets(box)) return false;
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

/// A power of two that brings the largest coordinate to [0.5, 1): exact, but where it underflows.
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

bool strictly_between(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
  for (int i = 0; i < 3; ++i) {  // on the line, it is between if it is along the first axis that tells
    if (a[i] != b[i]) return std::min(a[i], b[i]) < p[i] && p[i] < std::max(a[i], b[i]);
  }
  return false;
}

}  // namespace

Defect find_t_junctions(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit,
                        const Progress& progress) {
  const std::vector<std::uint32_t> vertices = used_vertices(mesh, graph);
  const double scale = scale_to_one(mesh, vertices);
  const auto scaled = [&](std::uint32_t v) { return scale * mesh.positions[v]; };
  std::vector<Box> points(vertices.size());
  for_each_index(points.size(), [&](std::size_t i) { points[i].include(scaled(vertices[i])); });
  const BoxTree tree(points);

  tbb::enumerable_thread_specific<DefectList> found(list_limit);
  tbb::enumerable_thread_specific<std::vector<std::uint32_t>> triangles;
  Progress::Counter counter(progress, graph.edges.size());
  const auto search = [&](std::uint32_t e) {
    const std::uint32_t a = graph.edges[e].a, b = graph.edges[e].b;
    const glm::dvec3 &at_a = mesh.positions[a], &at_b = mesh.positions[b];
    const SegmentQuery query(scaled(a), scaled(b));
    const auto visit = [&](std::uint32_t item) {
      const std::uint32_t v = vertices[item];
      if (v == a || v == b) return;
      const glm::dvec3& p = mesh.positions[v];
      if (!strictly_between(at_a, at_b, p) || !collinear(at_a, at_b, p)) return;
      std::vector<std::uint32_t>& around = triangles.local();
      around.clear();
      for (const Incidence& i : graph.around(e)) around.push_back(i.triangle);
      found.local().add(around, std::array{v, a, b});
    };
    tree.find([&](const Box& box) { return query.reaches(box); }, visit);
    counter.done_one();
  };
  // In the order of the tree, so that successive searches go the same ways through memory; edges are sorted by a.
  for_each_index(vertices.size(), [&](std::size_t i) {
    const std::uint32_t v = vertices[tree.order()[i]];
    auto edge = std::ranges::lower_bound(graph.edges, Edge{v, 0});
    for (; edge != graph.edges.end() && edge->a == v; ++edge) {
      search(static_cast<std::uint32_t>(edge - graph.edges.begin()));
    }
  });
  DefectList all(list_limit);
  for (DefectList& list : found) all.add_all(std::move(list));
  return std::move(all).finish(mesh);
}

}  // namespace penumbra::mesh
