// The diagnosis against CGAL's own functions on CGAL's own meshes. Polygons of more than three corners are cut into the
// same fans for both sides. Where CGAL's function means something else, the comparison says what and why.

#include "mesh/diagnosis.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace penumbra::mesh {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Polygon = std::vector<std::size_t>;

struct Soup {
  std::vector<Point> points;
  std::vector<Polygon> triangles;
};

/// Nothing if CGAL cannot read it.
std::optional<Soup> read(const std::filesystem::path& file) {
  Soup read;
  if (!CGAL::IO::read_polygon_soup(file.string(), read.points, read.triangles)) return std::nullopt;
  Soup soup{std::move(read.points), {}};
  for (const Polygon& polygon : read.triangles) {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      soup.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
  }
  return soup;
}

Diagnosis diagnosis_of(const Soup& soup) {
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  for (const Point& p : soup.points) positions.emplace_back(p.x(), p.y(), p.z());
  for (const Polygon& t : soup.triangles) {
    triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                         static_cast<std::uint32_t>(t[2])});
  }
  return diagnose({positions, triangles}, {.list_limit = std::numeric_limits<std::size_t>::max()});
}

bool repeats(const Polygon& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}
template <typename K = Kernel>
typename K::Triangle_3 corners(const Soup& soup, const Polygon& t) {
  const auto point = [&](std::size_t i) {
    const Point& p = soup.points[t[i]];
    return typename K::Point_3(p.x(), p.y(), p.z());
  };
  return {point(0), point(1), point(2)};
}

/// What CGAL's orienter says of a soup.
struct Singular {
  std::set<std::pair<Point, Point>> edges;
  std::set<Point> vertices;
};
struct Visitor : pmp::Default_orientation_visitor {
  std::set<std::pair<std::size_t, std::size_t>>* edges = nullptr;
  std::set<std::size_t>* vertices = nullptr;
  void non_manifold_edge(std::size_t a, std::size_t b, std::size_t) {
    if (edges != nullptr) edges->insert(std::minmax(a, b));
  }
  void non_manifold_vertex(std::size_t v, std::size_t) {
    if (vertices != nullptr) vertices->insert(v);
  }
};

/// By the definition: what two triangles share, constructed exactly, is no part of a vertex or edge of both.
bool meet_elsewhere(const Soup& soup, const Polygon& t, const Polygon& u) {
  std::vector<Exact::Point_3> shared;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::ranges::find(u, t[i]) != u.end()) shared.push_back(corners<Exact>(soup, t).vertex(static_cast<int>(i)));
  }
  if (shared.empty()) return CGAL::do_intersect(corners<Exact>(soup, t), corners<Exact>(soup, u));
  const auto common = CGAL::intersection(corners<Exact>(soup, t), corners<Exact>(soup, u));
  if (!common) return false;
  if (const auto* at = boost::get<Exact::Point_3>(&*common)) return std::ranges::find(shared, *at) == shared.end();
  const auto* along = boost::get<Exact::Segment_3>(&*common);
  if (along == nullptr || shared.size() != 2) return true;
  const Exact::Segment_3 edge(shared[0], shared[1]);
  return !edge.has_on(along->source()) || !edge.has_on(along->target());
}

std::uint64_t count_self_intersections(const Soup& soup) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, const Polygon*>;
  std::vector<Box> boxes;
  for (const Polygon& t : soup.triangles) {
    if (!corners(soup, t).is_degenerate()) boxes.emplace_back(corners(soup, t).bbox(), &t);
  }
  std::uint64_t count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (meet_elsewhere(soup, *a.info(), *b.info())) ++count;
  });
  return count;
}

/// At points at random in the bounds, the solid angles' sum over 4π; the farthest from an integer.
double worst_winding(const Soup& soup, const Diagnosis& diagnosis) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    glm::dvec3 q;
    for (int axis = 0; axis < 3; ++axis) {
      q[axis] = diagnosis.lower[axis] + unit(random) * (diagnosis.upper[axis] - diagnosis.lower[axis]);
    }
    double sum = 0;
    for (const Polygon& t : soup.triangles) {
      std::array<glm::dvec3, 3> r;
      for (std::size_t k = 0; k < 3; ++k) {
        const Point& p = soup.points[t[k]];
        r[k] = glm::dvec3(p.x(), p.y(), p.z()) - q;
      }
      const double a = glm::length(r[0]), b = glm::length(r[1]), c = glm::length(r[2]);
      sum += std::atan2(glm::dot(r[0], glm::cross(r[1], r[2])),
                        a * b * c + glm::dot(r[0], r[1]) * c + glm::dot(r[1], r[2]) * a + glm::dot(r[2], r[0]) * b);
    }
    const double w = sum / (2 * std::numbers::pi);
    worst = std::max(worst, std::abs(w - std::round(w)));
  }
  return worst;
}

void compare(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  SCOPED_TRACE(name);
  std::optional<Soup> loaded = read(file);
  if (!loaded) { fmt::print("{}: unreadable\n", name); return; }
  Soup soup = std::move(*loaded);
  const Diagnosis ours = diagnosis_of(soup);
  fmt::print("{}: t {} v {} closed {}{} be {} bl {} nme {} nmv {} iw {} dup {} opp {} za {} tj {} si {} comp {}", name, ours.triangles, ours.vertices, ours.closed, ours.closed_as_wound, ours.boundary_edges.count, ours.boundary_loops, ours.non_manifold_edges.count, ours.non_manifold_vertices.count, ours.inconsistent_windings.count, ours.duplicate_faces.count, ours.opposite_faces.count, ours.zero_area_triangles.count, ours.t_junctions.count, ours.self_intersections->count, ours.components);
  fmt::print(" gwn {:.2g}", worst_winding(soup, ours));
  pmp::merge_duplicate_points_in_polygon_soup(soup.points, soup.triangles);
  const auto degenerate = std::ranges::count_if(soup.triangles, [&](const Polygon& t) { return corners(soup, t).is_degenerate(); });
  EXPECT_EQ(ours.zero_area_triangles.count, static_cast<std::size_t>(degenerate));
  std::erase_if(soup.triangles, repeats);
  std::vector<Polygon> polygons = soup.triangles;
  EXPECT_EQ(ours.duplicate_faces.count, pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, polygons, CGAL::parameters::require_same_orientation(true)));
  EXPECT_EQ(ours.opposite_faces.count, pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, polygons));

  std::set<std::pair<std::size_t, std::size_t>> edges;
  std::set<std::size_t> vertices;
  Visitor visitor;
  visitor.edges = &edges, visitor.vertices = &vertices;
  Soup oriented = soup;
  const bool whole = pmp::orient_polygon_soup(oriented.points, oriented.triangles, CGAL::parameters::visitor(visitor));
  EXPECT_EQ(ours.non_manifold_edges.count, edges.size());
  EXPECT_EQ(ours.non_manifold_vertices.count, vertices.size());
  SurfaceMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(oriented.points, oriented.triangles, mesh);
  std::uint64_t border = 0;
  for (const auto h : mesh.halfedges()) border += mesh.is_border(h);
  std::vector<SurfaceMesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  EXPECT_EQ(ours.boundary_edges.count, border);
  EXPECT_EQ(ours.boundary_loops, cycles.size());
  auto ids = mesh.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:component", 0).first;
  EXPECT_EQ(ours.components, pmp::connected_components(mesh, ids));
  EXPECT_EQ(ours.closed, CGAL::is_closed(mesh));
  if (whole) {
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
    pmp::self_intersections(mesh, std::back_inserter(pairs));
    std::erase_if(pairs, [](const auto& p) { return p.first == p.second; });
    EXPECT_EQ(ours.self_intersections->count, pairs.size());
  } else {
    const auto exact = count_self_intersections(soup);
    EXPECT_EQ(ours.self_intersections->count, exact);
  }
  if (CGAL::is_closed(mesh)) fmt::print(" vol {} {}", ours.volume, pmp::volume(mesh));
  fmt::print(" whole {} polymesh {}\n", whole, pmp::is_polygon_soup_a_polygon_mesh(soup.triangles));
}

TEST(CgalMeshes, All) {
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_CGAL_CORPUS "/meshes")) {
    if (entry.path().extension() == ".off") compare(entry.path());
  }
}

}  // namespace
}  // namespace penumbra::mesh
