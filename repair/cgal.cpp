// SPDX-License-Identifier: Apache-2.0
// Orients closed parts outward and fills holes with CGAL's Polygon Mesh Processing.

#include "repair/cgal.hpp"

#include "mesh/box_tree.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace penumbra::repair {
namespace {

using mesh::Box;
using mesh::collinear;

namespace pmp = CGAL::Polygon_mesh_processing;
using Face = CgalMesh::Face_index;
using HalfEdge = CgalMesh::Halfedge_index;

void say_nothing(const char*, const char*, const char*, int, const char*) {}

Box bounds(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  Box box;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t i : soup.triangles[t]) box.include(soup.positions[i]);
  }
  return box;
}

bool strictly_inside(const Box& inner, const Box& outer) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.lower[axis] <= outer.lower[axis] || inner.upper[axis] >= outer.upper[axis]) return false;
  }
  return true;
}

/// Returns six times the signed volume. Reversing every triangle exactly negates the volume, so that a second repair
/// reverses nothing.
double volume(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  const glm::dvec3 origin = soup.positions[soup.triangles[triangles[0]][0]];
  double sum = 0;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = soup.triangles[t];
    sum += glm::dot(soup.positions[a] - origin, glm::cross(soup.positions[b] - origin, soup.positions[c] - origin));
  }
  return sum;
}

/// Returns the closed parts that CGAL reverses so that together they bound a volume.
std::vector<std::uint32_t> inverted_parts(const TriangleSoup& soup, const SurfaceParts& parts, CgalSurface& surface) {
  pmp::orient_to_bound_a_volume(surface.mesh);
  std::set<std::uint32_t> inverted;
  for (const Face face : surface.mesh.faces()) {
    const std::uint32_t t = surface.triangle[face];
    const auto now = corners(surface.mesh, face);
    const auto first = std::ranges::find(now, CgalMesh::Vertex_index(soup.triangles[t][0])) - now.begin();
    if (now[static_cast<std::size_t>(first + 1) % 3] != CgalMesh::Vertex_index(soup.triangles[t][1])) {
      inverted.insert(parts.of_triangle[t]);
    }
  }
  return {inverted.begin(), inverted.end()};
}

/// Fallback if CGAL cannot orient the parts to bound a volume: returns the parts of negative volume that are inside no
/// other part's bounds.
std::vector<std::uint32_t> inside_out_parts(const TriangleSoup& soup, const SurfaceParts& parts) {
  std::vector<std::uint32_t> closed;
  std::vector<Box> boxes;
  for (std::uint32_t part = 0; part < parts.closed.size(); ++part) {
    if (!parts.closed[part]) continue;
    closed.push_back(part);
    boxes.push_back(bounds(soup, parts.triangles[part]));
  }
  std::vector<std::uint32_t> turned;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (volume(soup, parts.triangles[closed[i]]) >= 0) continue;
    if (std::ranges::any_of(boxes, [&](const Box& outer) { return strictly_inside(boxes[i], outer); })) continue;
    turned.push_back(closed[i]);
  }
  return turned;
}

glm::dvec3 at(const CgalMesh& mesh, CgalMesh::Vertex_index v) {
  const CgalPoint& p = mesh.point(v);
  return {p.x(), p.y(), p.z()};
}

/// Returns whether the triangle left of h has no area, or is folded back onto the face behind that edge.
bool is_flat_or_folded(const CgalMesh& mesh, HalfEdge h) {
  const auto a = mesh.source(h), b = mesh.target(h), c = mesh.target(mesh.next(h));
  if (collinear(at(mesh, a), at(mesh, b), at(mesh, c))) return true;
  if (mesh.is_border(mesh.opposite(h))) return false;
  const auto d = mesh.target(mesh.next(mesh.opposite(h)));
  return CGAL::coplanar(mesh.point(a), mesh.point(b), mesh.point(c), mesh.point(d)) &&
         CGAL::coplanar_orientation(mesh.point(a), mesh.point(b), mesh.point(c), mesh.point(d)) != CGAL::NEGATIVE;
}

/// Decides whether the filling of a hole is a valid addition to the surface: with area, not folded back, with no inner
/// edge on an existing edge and no triangle on an existing one.
class FillingJudge {
 public:
  explicit FillingJudge(const TriangleSoup& soup) : graph_(build_edge_graph({soup.positions, soup.triangles})) {
    for (const Triangle& triangle : soup.triangles) triangles_.insert(sorted(graph_.corners(triangle)));
    edges_.insert(graph_.edges.begin(), graph_.edges.end());
  }

  /// Records the filling if it is valid, and returns whether it is.
  bool accept(const CgalMesh& mesh, std::vector<Face> patch) {
    std::ranges::sort(patch);
    std::set<Edge> inner;
    for (const Face face : patch) {
      const auto [a, b, c] = corners(mesh, face);
      if (triangles_.contains(sorted(graph_.corners({a.idx(), b.idx(), c.idx()})))) return false;
      for (const HalfEdge h : CGAL::halfedges_around_face(mesh.halfedge(face), mesh)) {
        if (is_flat_or_folded(mesh, h)) return false;
        const bool is_inner = std::ranges::binary_search(patch, mesh.face(mesh.opposite(h)));
        const auto [from, to] = std::minmax(graph_.vertex[mesh.source(h).idx()], graph_.vertex[mesh.target(h).idx()]);
        if (is_inner) inner.insert({from, to});
      }
    }
    if (std::ranges::any_of(inner, [&](const Edge& edge) { return edges_.contains(edge); })) return false;
    edges_.insert(inner.begin(), inner.end());
    for (const Face face : patch) {
      const auto [a, b, c] = corners(mesh, face);
      triangles_.insert(sorted(graph_.corners({a.idx(), b.idx(), c.idx()})));
    }
    return true;
  }

 private:
  static Triangle sorted(Triangle triangle) {
    std::ranges::sort(triangle);
    return triangle;
  }

  EdgeGraph graph_;
  std::set<Triangle> triangles_;
  std::set<Edge> edges_;
};

struct Hole {
  HalfEdge border;
  std::size_t edges = 0;
  std::uint32_t neighbour = CgalSurface::kNew;  // the lowest triangle around the hole
};

std::vector<Hole> find_holes(const CgalSurface& surface) {
  std::vector<HalfEdge> cycles;
  pmp::extract_boundary_cycles(surface.mesh, std::back_inserter(cycles));
  std::vector<Hole> holes;
  for (const HalfEdge border : cycles) {
    Hole& hole = holes.emplace_back();
    hole.border = border;
    for (const HalfEdge h : CGAL::halfedges_around_face(border, surface.mesh)) {
      ++hole.edges;
      hole.neighbour = std::min(hole.neighbour, surface.triangle[surface.mesh.face(surface.mesh.opposite(h))]);
    }
  }
  std::ranges::sort(holes, {}, &Hole::neighbour);
  return holes;
}

struct Filling {
  std::uint32_t neighbour;
  std::size_t first_triangle, triangles;
};

/// Returns the triangles from `first_new` on that meet others elsewhere than in common points.
std::set<std::size_t> crossing_fillings(const TriangleSoup& soup, std::size_t first_new) {
  if (soup.triangles.size() == first_new) return {};
  const CgalSurface surface = to_cgal(soup);
  std::set<std::size_t> crossing;
  for (const auto& [f, g] : intersections(surface.mesh)) {
    for (const Face face : {f, g}) {
      if (surface.triangle[face] >= first_new) crossing.insert(surface.triangle[face]);
    }
  }
  return crossing;
}

}  // namespace

QuietCgal::QuietCgal()
    : error_(CGAL::set_error_handler(say_nothing)), warning_(CGAL::set_warning_handler(say_nothing)) {}
QuietCgal::~QuietCgal() {
  CGAL::set_error_handler(error_);
  CGAL::set_warning_handler(warning_);
}

CgalSurface to_cgal(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  CgalSurface surface;
  surface.triangle = surface.mesh.add_property_map<Face, std::uint32_t>("f:triangle", CgalSurface::kNew).first;
  for (const glm::dvec3& p : soup.positions) surface.mesh.add_vertex(CgalPoint(p.x, p.y, p.z));
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = soup.triangles[t];
    using Vertex = CgalMesh::Vertex_index;
    const Face face = surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
    if (face == CgalMesh::null_face()) throw std::logic_error("the joined triangles are no manifold for CGAL");
    surface.triangle[face] = t;
  }
  for (const auto v : surface.mesh.vertices()) {
    if (surface.mesh.is_isolated(v)) surface.mesh.remove_vertex(v);  // the other vertices keep their indices
  }
  return surface;
}

CgalSurface to_cgal(const TriangleSoup& soup) {
  std::vector<std::uint32_t> all(soup.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return to_cgal(soup, all);
}

std::array<CgalMesh::Vertex_index, 3> corners(const CgalMesh& mesh, Face face) {
  const HalfEdge h = mesh.halfedge(face);
  return {mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
}

SurfaceParts surface_parts(const TriangleSoup& soup) {
  struct Rim {  // a triangle's side
    std::uint32_t a, b, triangle;
    auto operator<=>(const Rim&) const = default;
  };
  std::vector<Rim> sides;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(soup.triangles[t][i], soup.triangles[t][(i + 1) % 3]);
      sides.push_back({a, b, t});
    }
  }
  std::ranges::sort(sides);
  std::vector<std::uint32_t> parent(soup.triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  std::vector<std::uint32_t> open;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto is_pair = [&](std::size_t j) {
      return j + 1 < sides.size() && sides[j].a == sides[j + 1].a && sides[j].b == sides[j + 1].b;
    };
    if (is_pair(i)) {
      const std::uint32_t s = root(sides[i].triangle), t = root(sides[i + 1].triangle);
      parent[std::max(s, t)] = std::min(s, t);
    } else if (i == 0 || !is_pair(i - 1)) {
      open.push_back(sides[i].triangle);
    }
  }
  SurfaceParts parts;
  parts.of_triangle.resize(soup.triangles.size());
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    if (root(t) == t) {
      parts.of_triangle[t] = static_cast<std::uint32_t>(parts.triangles.size());
      parts.triangles.emplace_back();
    }
    parts.of_triangle[t] = parts.of_triangle[root(t)];
    parts.triangles[parts.of_triangle[t]].push_back(t);
  }
  parts.closed.assign(parts.triangles.size(), true);
  for (const std::uint32_t t : open) parts.closed[parts.of_triangle[t]] = false;
  return parts;
}

TriangleSoup turn_outward(const TriangleSoup& soup, RepairRecord& record) {
  const QuietCgal quiet;
  const SurfaceParts parts = surface_parts(soup);
  std::vector<std::uint32_t> closed;
  for (std::uint32_t part = 0; part < parts.closed.size(); ++part) {
    if (parts.closed[part]) closed.insert(closed.end(), parts.triangles[part].begin(), parts.triangles[part].end());
  }
  if (closed.empty()) return soup;
  CgalSurface surface = to_cgal(soup, closed);
  const std::vector<std::uint32_t> turned =
      pmp::does_self_intersect(surface.mesh) ? inside_out_parts(soup, parts) : inverted_parts(soup, parts, surface);
  TriangleSoup repaired = soup;
  for (const std::uint32_t part : turned) {
    for (const std::uint32_t t : parts.triangles[part]) std::swap(repaired.triangles[t][1], repaired.triangles[t][2]);
  }
  record[RepairKind::outward] += turned.size();
  return repaired;
}

TriangleSoup fill_holes(const TriangleSoup& soup, std::uint32_t most_edges, RepairRecord& record) {
  const QuietCgal quiet;
  CgalSurface surface = to_cgal(soup);
  FillingJudge judge(soup);
  std::vector<Filling> fillings;
  std::size_t unfilled = 0;
  TriangleSoup tried = soup;
  for (const Hole& hole : find_holes(surface)) {
    if (hole.edges > most_edges) continue;
    std::vector<Face> patch;
    pmp::triangulate_hole(surface.mesh, hole.border, std::back_inserter(patch));
    // the mesh keeps the patch, but the soup does not get it
    if (patch.empty() || !judge.accept(surface.mesh, patch)) {
      ++unfilled;
      continue;
    }
    fillings.push_back({hole.neighbour, tried.triangles.size(), patch.size()});
    for (const Face face : patch) {
      const auto [a, b, c] = corners(surface.mesh, face);
      tried.triangles.push_back({a.idx(), b.idx(), c.idx()});
    }
  }
  const std::set<std::size_t> crossing = crossing_fillings(tried, soup.triangles.size());
  TriangleSoup repaired = soup;
  for (const Filling& filling : fillings) {
    const auto end = crossing.lower_bound(filling.first_triangle + filling.triangles);
    if (crossing.lower_bound(filling.first_triangle) != end) {
      ++unfilled;
      continue;
    }
    ++record[RepairKind::hole];
    record[RepairKind::hole_face] += filling.triangles;
    const auto first = tried.triangles.begin() + static_cast<std::ptrdiff_t>(filling.first_triangle);
    repaired.triangles.insert(repaired.triangles.end(), first, first + static_cast<std::ptrdiff_t>(filling.triangles));
    repaired.object.resize(repaired.triangles.size(), soup.object[filling.neighbour]);
    repaired.source_face.resize(repaired.triangles.size(), soup.source_face[filling.neighbour]);
  }
  if (unfilled > 0) {
    record.left.push_back(
        fmt::format("{} holes of at most {} edges stay open: their filling would have no area, or lie on or cross "
                    "existing surfaces",
                    unfilled, most_edges));
  }
  return repaired;
}

}  // namespace penumbra::repair
