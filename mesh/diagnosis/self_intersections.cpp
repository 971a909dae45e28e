// SPDX-License-Identifier: Apache-2.0
// Self-intersections of a soup, exact. The cases by shared vertices are those of CGAL's polygon mesh processing,
// self_intersections(); the predicates come from CGAL's kernel (LGPL).
//
// Whether two triangles meet depends only on their vertices. So triangles with the same three vertices are searched as
// one surface, and each result counts for all of them: n triangles in one place cost n log n, not n².
//
// All triangles at one vertex have boxes that overlap there: a fan of n would cost n². Two triangles with a common
// vertex meet elsewhere exactly if some ray from that vertex goes into both. So triangles at a hub, a vertex of many
// triangles, are searched by the directions in which they lie, and the search by boxes skips pairs that have a hub in
// common.

#include "mesh/diagnosis/self_intersections.hpp"

#include "mesh/box_tree.hpp"
#include "mesh/diagnosis/defect_list.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

/// Tests whether two triangles with at most two common vertices meet.
class PairTest {
 public:
  PairTest(const MeshView& mesh, const EdgeGraph& graph) : mesh_(mesh), graph_(graph) {}

  bool operator()(std::uint32_t t, std::uint32_t u) const {
    // Shared vertices come first, in the same order in both triangles.
    Triangle a = graph_.corners(mesh_.triangles[t]), b = graph_.corners(mesh_.triangles[u]);
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto match = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
      if (match == b.end()) continue;
      std::swap(a[i], a[shared]);
      std::iter_swap(match, b.begin() + static_cast<std::ptrdiff_t>(shared));
      ++shared;
    }
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

  /// Tests triangles with p[0] == q[0]. The intersection is convex; if it contains another point, the ray from the
  /// vertex through that point leaves one triangle first, through the far edge, inside the other.
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

/// Triangles with the same three vertices, in ascending order.
using Copies = std::span<const std::uint32_t>;

/// All triangles with an area, grouped by their three vertices.
class Surfaces {
 public:
  Surfaces(const MeshView& mesh, const EdgeGraph& graph) {
    std::vector<std::pair<Triangle, std::uint32_t>> sorted;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (graph.kind[t] != TriangleKind::proper) continue;
      Triangle corners = graph.corners(mesh.triangles[t]);
      std::ranges::sort(corners);
      sorted.emplace_back(corners, t);
    }
    std::ranges::sort(sorted);
    triangles_.reserve(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (i == 0 || sorted[i].first != sorted[i - 1].first) first_.push_back(i);
      triangles_.push_back(sorted[i].second);
    }
    first_.push_back(sorted.size());
  }

  [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
  Copies operator[](std::size_t surface) const {
    return Copies(triangles_).subspan(first_[surface], first_[surface + 1] - first_[surface]);
  }

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<std::size_t> first_;  ///< begin of each surface in `triangles_`, and the end of the last
};

/// The pairs of triangles that meet: all are counted, the first ones listed.
class PairList {
 public:
  PairList(const MeshView& mesh, const EdgeGraph& graph, std::size_t limit)
      : mesh_(mesh), graph_(graph), limit_(limit), list_(limit) {}

  /// Adds every triangle of one surface with every triangle of another.
  void add(Copies a, Copies b) {
    const std::uint64_t all = std::uint64_t{a.size()} * b.size();
    std::size_t listed = 0;
    while (listed < limit_ && !a.empty() && !b.empty()) {  // in list order, until the list is full
      if (a.front() > b.front()) std::swap(a, b);
      listed += add_first(a.front(), b.first(std::min(b.size(), limit_ - listed)));
      a = a.subspan(1);
    }
    list_.count(all - listed);
  }
  /// Adds every two triangles of one surface.
  void add(Copies same) {
    const std::uint64_t all = std::uint64_t{same.size()} * (same.size() - 1) / 2;
    std::size_t listed = 0;
    while (listed < limit_ && same.size() > 1) {
      const Copies later = same.subspan(1);
      listed += add_first(same.front(), later.first(std::min(later.size(), limit_ - listed)));
      same = later;
    }
    list_.count(all - listed);
  }
  [[nodiscard]] DefectList take() && { return std::move(list_); }

 private:
  std::size_t add_first(std::uint32_t t, Copies later) {
    const Triangle a = graph_.corners(mesh_.triangles[t]);
    for (const std::uint32_t u : later) {
      const Triangle b = graph_.corners(mesh_.triangles[u]);
      list_.add({t, u}, {a[0], a[1], a[2], b[0], b[1], b[2]});
    }
    return later.size();
  }

  const MeshView& mesh_;
  const EdgeGraph& graph_;
  std::size_t limit_;
  DefectList list_;
};

constexpr std::uint32_t kNone = 0xffffffffu;

/// Hubs: vertices of more than kCrowd surfaces, and the surfaces at each.
class Hubs {
 public:
  static constexpr std::uint32_t kCrowd = 64;
  using Few = std::array<std::uint32_t, 3>;  ///< a triangle's vertices that are hubs; kNone for the others

  Hubs(const MeshView& mesh, const EdgeGraph& graph, const Surfaces& surfaces) : mesh_(mesh) {
    corners_.resize(surfaces.size());
    std::vector<std::uint32_t> count(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      corners_[i] = graph.corners(mesh.triangles[surfaces[i].front()]);
      for (const std::uint32_t v : corners_[i]) ++count[v];
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      for (const std::uint32_t v : corners_[i]) {
        if (count[v] > kCrowd) at_hubs_.emplace_back(v, static_cast<std::uint32_t>(i));
      }
    }
    std::ranges::sort(at_hubs_);
    is_hub_.resize(at_hubs_.empty() ? 0 : count.size());
    for (const auto& [v, surface] : at_hubs_) is_hub_[v] = true;
  }

  [[nodiscard]] bool empty() const { return at_hubs_.empty(); }
  [[nodiscard]] Few of(std::uint32_t surface) const {
    Few hubs = corners_[surface];
    for (std::uint32_t& v : hubs) v = is_hub_[v] ? v : kNone;
    return hubs;
  }
  static Few common(const Few& a, const Few& b) {
    Few both = a;
    for (std::uint32_t& v : both) v = std::ranges::find(b, v) != b.end() ? v : kNone;
    return both;
  }
  static bool have_common(const Few& a, const Few& b) { return first(common(a, b)) != kNone; }

  /// Calls visit(surface, other) once for each pair with a common hub that may meet elsewhere than in shared vertices.
  template <typename Visit>
  void find_pairs(const Visit& visit) const {
    for (std::size_t begin = 0, end = 0; begin < at_hubs_.size(); begin = end) {
      const std::uint32_t hub = at_hubs_[begin].first;
      while (end < at_hubs_.size() && at_hubs_[end].first == hub) ++end;
      const auto here = std::span(at_hubs_).subspan(begin, end - begin);
      std::vector<Box> boxes(here.size());
      for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = directions(corners_[here[i].second], hub);
      const BoxTree tree(boxes);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, here.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const std::uint32_t item = tree.order()[i], surface = here[item].second;
          tree.find([&](const Box& box) { return box.meets(boxes[item]); },
                    [&](std::uint32_t other) {
                      // With two common hubs, the pair is handled at the first.
                      if (other > item && first(common(of(surface), of(here[other].second))) == hub)
                        visit(surface, here[other].second);
                    });
        }
      });
    }
  }

 private:
  static std::uint32_t first(const Few& hubs) { return std::ranges::min(hubs); }

  /// Returns a box around the unit vectors from the hub into the triangle: these form an arc between two unit vectors,
  /// which is no farther from its chord, of length c, than 1 − √(1 − c²/4) ≤ c²/4. Rounding is far below 2⁻⁴⁰.
  [[nodiscard]] Box directions(const Triangle& corners, std::uint32_t hub) const {
    std::array<glm::dvec3, 2> ends;
    std::size_t count = 0;
    for (const std::uint32_t v : corners) {
      if (v == hub) continue;
      const glm::dvec3 direction = 0.5 * mesh_.positions[v] - 0.5 * mesh_.positions[hub], size = glm::abs(direction);
      ends[count++] = glm::normalize(direction / std::max({size.x, size.y, size.z}));
    }
    const glm::dvec3 chord = ends[1] - ends[0], more(glm::dot(chord, chord) / 4 + 0x1p-40);
    return {glm::min(ends[0], ends[1]) - more, glm::max(ends[0], ends[1]) + more};
  }

  const MeshView& mesh_;
  std::vector<Triangle> corners_;                                 ///< corners of each surface
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_hubs_;  ///< (hub, surface), sorted
  std::vector<bool> is_hub_;                                      ///< for each vertex; empty if there are no hubs
};

}  // namespace

Defect find_self_intersections(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit,
                               const Progress& progress) {
  const Surfaces surfaces(mesh, graph);
  std::vector<Box> boxes(surfaces.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t v : graph.corners(mesh.triangles[surfaces[i].front()]))
      boxes[i].include(mesh.positions[v]);
  }
  const BoxTree tree(boxes);
  const Hubs hubs(mesh, graph, surfaces);
  std::vector<Hubs::Few> below;  // for each node, the hubs that all surfaces below it have in common
  if (!hubs.empty()) below = tree.fold([&](std::uint32_t item) { return hubs.of(item); }, Hubs::common);
  const PairTest meet(mesh, graph);
  tbb::enumerable_thread_specific<PairList> found([&] { return PairList(mesh, graph, list_limit); });
  Progress::Counter counter(progress, surfaces.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surfaces.size(), 64), [&](const auto& range) {
    PairList& list = found.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::uint32_t item = tree.order()[i];
      const Copies copies = surfaces[item];
      list.add(copies);
      const Hubs::Few own = hubs.empty() ? Hubs::Few{kNone, kNone, kNone} : hubs.of(item);
      const bool has_hub = std::ranges::min(own) != kNone;
      const auto enters = [&](std::uint32_t node) { return !has_hub || !Hubs::have_common(own, below[node]); };
      const auto visit = [&](std::uint32_t other) {
        if (other <= item || (has_hub && Hubs::have_common(own, hubs.of(other)))) return;
        if (meet(copies.front(), surfaces[other].front())) list.add(copies, surfaces[other]);
      };
      tree.find(
          enters, [&](const Box& box) { return box.meets(boxes[item]); }, visit);
      counter.done_one();
    }
  });
  hubs.find_pairs([&](std::uint32_t surface, std::uint32_t other) {
    if (meet(surfaces[surface].front(), surfaces[other].front())) found.local().add(surfaces[surface], surfaces[other]);
  });
  DefectList all(list_limit);
  for (PairList& list : found) all.add_all(std::move(list).take());
  return std::move(all).finish(mesh);
}

}  // namespace penumbra::mesh
