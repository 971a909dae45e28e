// The cases by shared vertices are those of CGAL's polygon mesh processing, self_intersections(); the predicates are
// its kernel's (LGPL).

#include "mesh/diagnosis/self_intersections.hpp"

#include "mesh/box_tree.hpp"
#include "mesh/diagnosis/defect_list.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>

namespace penumbra::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

class PairTest {
 public:
  PairTest(const MeshView& mesh, const EdgeGraph& graph) : mesh_(mesh), graph_(graph) {}

  bool operator()(std::uint32_t t, std::uint32_t u) const {
    // Shared vertices first, in the same order in both.
    Triangle a = graph_.corners(mesh_.triangles[t]), b = graph_.corners(mesh_.triangles[u]);
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto match = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
      if (match == b.end()) continue;
      std::swap(a[i], a[shared]);
      std::iter_swap(match, b.begin() + static_cast<std::ptrdiff_t>(shared));
      ++shared;
    }
    if (shared == 3) return true;
    const std::array<Point, 3> p = points(a), q = points(b);
    if (shared == 2) return fold_onto_one_another(p[0], p[1], p[2], q[2]);
    if (shared == 1) return meet_away_from_vertex(p, q);
    return CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]), Kernel::Triangle_3(q[0], q[1], q[2]));
  }

 private:
  std::array<Point, 3> points(const Triangle& triangle) const {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& at = mesh_.positions[triangle[i]];
      p[i] = Point(at.x, at.y, at.z);
    }
    return p;
  }

  static bool fold_onto_one_another(const Point& a, const Point& b, const Point& p, const Point& q) {
    return CGAL::coplanar(a, b, p, q) && CGAL::coplanar_orientation(a, b, p, q) == CGAL::POSITIVE;
  }

  /// Triangles with p[0] == q[0]. What they share is convex; if it holds another point, follow the ray through it from
  /// the vertex: it leaves one triangle first, through the far edge, inside the other.
  static bool meet_away_from_vertex(const std::array<Point, 3>& p, const std::array<Point, 3>& q) {
    const CGAL::Orientation q1 = CGAL::orientation(p[0], p[1], p[2], q[1]);
    const CGAL::Orientation q2 = CGAL::orientation(p[0], p[1], p[2], q[2]);
    if (q1 == q2 && q1 != CGAL::COPLANAR) return false;  // strictly on one side, except for the shared vertex
    const Kernel::Triangle_3 s(p[0], p[1], p[2]), t(q[0], q[1], q[2]);
    return CGAL::do_intersect(s, Kernel::Segment_3(q[1], q[2])) || CGAL::do_intersect(t, Kernel::Segment_3(p[1], p[2]));
  }

  const MeshView& mesh_;
  const EdgeGraph& graph_;
};

}  // namespace

Defect find_self_intersections(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit,
                               const Progress& progress) {
  std::vector<std::uint32_t> proper;
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (graph.kind[t] != TriangleKind::proper) continue;
    proper.push_back(t);
    Box& box = boxes.emplace_back();
    for (const std::uint32_t v : graph.corners(mesh.triangles[t])) box.include(mesh.positions[v]);
  }
  const BoxTree tree(boxes);
  const PairTest meet(mesh, graph);
  tbb::enumerable_thread_specific<DefectList> found(list_limit);
  Progress::Counter counter(progress, proper.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, proper.size(), 64), [&](const auto& range) {
    DefectList& list = found.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::uint32_t item = tree.order()[i];
      const auto visit = [&](std::uint32_t other) {
        if (other <= item || !meet(proper[item], proper[other])) return;
        const Triangle a = graph.corners(mesh.triangles[proper[item]]),
                       b = graph.corners(mesh.triangles[proper[other]]);
        list.add({proper[item], proper[other]}, {a[0], a[1], a[2], b[0], b[1], b[2]});
      };
      tree.find([&](const Box& box) { return box.meets(boxes[item]); }, visit);
      counter.done_one();
    }
  });
  DefectList all(list_limit);
  for (DefectList& list : found) all.add_all(std::move(list));
  return std::move(all).finish(mesh);
}

}  // namespace penumbra::mesh
