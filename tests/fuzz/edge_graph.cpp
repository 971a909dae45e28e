// SPDX-License-Identifier: Apache-2.0
// Fuzzes edge graph, silhouettes and diagnosis of any small soup, and compares them with definitions in their headers,
// applied by brute force. On a lattice of small integers, scaled by any power of two in double's range, signs are those
// of integers; with arbitrary coordinates only results without signs are checked.
#include "base/assert.hpp"
#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/silhouettes.hpp"
#include "tests/fuzz/bytes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace {

using namespace penumbra::mesh;
using penumbra::fuzz::Bytes;
using Point = std::array<std::int64_t, 3>;

struct Soup {
  bool lattice = true;
  double scale = 1;           ///< a power of two
  std::vector<Point> points;  ///< on a lattice only: positions = scale · points
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
  [[nodiscard]] glm::dvec3 placed(const Point& p) const {
    return scale * glm::dvec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
  }
};

Point lattice_point(Bytes& bytes) {
  const auto packed = bytes.take<std::uint16_t>();
  return {packed & 7, (packed >> 3) & 7, (packed >> 6) & 7};
}

double wild_number(Bytes& bytes) {
  const auto x = bytes.take<double>();
  return std::isfinite(x) ? x : 0;
}

Soup make_soup(Bytes& bytes) {
  Soup soup;
  const auto head = bytes.take<std::uint16_t>();
  soup.lattice = (head & 3) != 3;
  soup.scale = std::ldexp(1.0, static_cast<int>(bytes.take<std::uint16_t>() % 2000) - 1000);
  const auto positions = static_cast<std::uint32_t>(1 + (head >> 2) % 32);
  for (std::uint32_t i = 0; i < positions; ++i) {
    if (soup.lattice) {
      soup.points.push_back(lattice_point(bytes));
      soup.positions.push_back(soup.placed(soup.points.back()));
      if ((head & 3) == 2) soup.positions.back() = -soup.positions.back();  // then zeros are −0
    } else {
      const double x = wild_number(bytes), y = wild_number(bytes), z = wild_number(bytes);
      soup.positions.emplace_back(x, y, z);
    }
  }
  if (soup.lattice && (head & 3) == 2) {
    for (Point& p : soup.points) p = {-p[0], -p[1], -p[2]};
  }
  constexpr std::size_t kMostTriangles = 40;
  while (!bytes.empty() && soup.triangles.size() < kMostTriangles) {
    Triangle triangle{};
    for (std::uint32_t& corner : triangle) corner = bytes.take<std::uint8_t>() % positions;
    soup.triangles.push_back(triangle);
  }
  return soup;
}

Point cross(const Point& a, const Point& b, const Point& c) {  // (b − a) × (c − a)
  const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

int sign_of_plane(const Point& a, const Point& b, const Point& c, const Point& p) {
  const Point n = cross(a, b, c);
  const std::int64_t d = n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2]);
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

bool on_line(const Point& a, const Point& b, const Point& c) {
  return cross(a, b, c) == Point{0, 0, 0};
}

bool inside_edge(const Point& a, const Point& b, const Point& v) {
  if (!on_line(a, b, v)) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a[axis] != b[axis]) return std::min(a[axis], b[axis]) < v[axis] && v[axis] < std::max(a[axis], b[axis]);
  }
  return false;
}

void check_graph(const Soup& soup, const EdgeGraph& graph) {
  for (std::uint32_t i = 0; i < soup.positions.size(); ++i) {
    std::uint32_t first = 0;
    while (soup.positions[first] != soup.positions[i]) ++first;
    PENUMBRA_ASSERT(graph.vertex[i] == first, "position {}: vertex {}, not {}", i, graph.vertex[i], first);
  }
  std::map<Edge, std::vector<Incidence>> known;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle c = graph.corners(soup.triangles[t]);
    const bool repeated = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    PENUMBRA_ASSERT((graph.kind[t] == TriangleKind::repeated) == repeated, "triangle {}", t);
    if (soup.lattice && !repeated) {
      const bool line = on_line(soup.points[c[0]], soup.points[c[1]], soup.points[c[2]]);
      PENUMBRA_ASSERT((graph.kind[t] == TriangleKind::collinear) == line, "triangle {}: collinear {}", t, line);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t edge = graph.triangle_edges[t][i];
      PENUMBRA_ASSERT((edge == EdgeGraph::kNoEdge) == repeated, "triangle {}, corner {}: edge {}", t, i, edge);
      if (repeated) continue;
      const std::uint32_t from = c[i], to = c[(i + 1) % 3];
      const Edge named{std::min(from, to), std::max(from, to)};
      PENUMBRA_ASSERT(graph.edges[edge] == named, "triangle {}, corner {}: edge {}", t, i, edge);
      known[named].push_back({t, c[(i + 2) % 3], from > to});
    }
  }
  PENUMBRA_ASSERT(graph.edges.size() == known.size(), "{} edges, not {}", graph.edges.size(), known.size());
  std::uint32_t number = 0;
  for (const auto& [edge, incidences] : known) {  // both in ascending order
    PENUMBRA_ASSERT(graph.edges[number] == edge && std::ranges::equal(graph.around(number), incidences), "edge {}",
                    number);
    ++number;
  }
}

/// Returns k_e(p) by its definition, for every edge; triangles are wound counter-clockwise as seen from p.
std::vector<int> multiplicities(const Soup& soup, const EdgeGraph& graph, const Point& p) {
  std::vector<int> k(graph.edges.size(), 0);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle c = graph.corners(soup.triangles[t]);
    const int side = sign_of_plane(soup.points[c[0]], soup.points[c[1]], soup.points[c[2]], p);
    if (side == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) k[graph.triangle_edges[t][i]] += c[i] < c[(i + 1) % 3] ? side : -side;
  }
  return k;
}

void check_silhouettes(const Soup& soup, const EdgeGraph& graph, Bytes& bytes) {
  std::array<Point, 4> hull;
  std::vector<glm::dvec3> corners;
  for (Point& p : hull) {
    p = lattice_point(bytes);
    for (std::int64_t& x : p) x = 4 * (x - 2);  // even, so that the middle of two points is a lattice point, too
    corners.push_back(soup.placed(p));
  }
  const std::vector<std::uint32_t> possible = possible_silhouette_edges(soup.view(), graph, corners);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Point p = {(hull[i][0] + hull[j][0]) / 2, (hull[i][1] + hull[j][1]) / 2, (hull[i][2] + hull[j][2]) / 2};
      const std::vector<int> k = multiplicities(soup, graph, p);
      std::vector<SilhouetteEdge> known;
      std::map<std::uint32_t, int> flow;  // flow into each vertex
      for (std::uint32_t e = 0; e < k.size(); ++e) {
        if (k[e] == 0) continue;
        known.push_back({e, k[e]});
        flow[graph.edges[e].a] -= k[e];
        flow[graph.edges[e].b] += k[e];
        PENUMBRA_ASSERT(std::ranges::binary_search(possible, e), "edge {} is a silhouette, but said to be none", e);
      }
      PENUMBRA_ASSERT(silhouette_edges(soup.view(), graph, soup.placed(p)) == known, "silhouettes from ({}, {}, {})",
                      p[0], p[1], p[2]);
      for (const auto& [vertex, sum] : flow) PENUMBRA_ASSERT(sum == 0, "vertex {}: {}", vertex, sum);
    }
  }
}

/// Returns whether the signed boundary, cut at every vertex that lies on it, cancels.
bool closed_by_brute_force(const Soup& soup, const EdgeGraph& graph) {
  std::map<Edge, int> boundary;
  for (const Triangle& triangle : soup.triangles) {
    const Triangle c = graph.corners(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = c[i], to = c[(i + 1) % 3];
      if (from == to) continue;
      std::vector<std::uint32_t> on = {from, to};
      for (std::uint32_t v = 0; v < soup.points.size(); ++v) {
        if (graph.vertex[v] == v && inside_edge(soup.points[from], soup.points[to], soup.points[v])) on.push_back(v);
      }
      std::ranges::sort(on, [&](std::uint32_t a, std::uint32_t b) { return soup.points[a] < soup.points[b]; });
      const int sign = soup.points[from] < soup.points[to] ? 1 : -1;
      for (std::size_t s = 0; s + 1 < on.size(); ++s) boundary[Edge{on[s], on[s + 1]}] += sign;
    }
  }
  return std::ranges::all_of(boundary, [](const auto& piece) { return piece.second == 0; });
}

std::uint64_t t_junctions_by_brute_force(const Soup& soup, const EdgeGraph& graph) {
  std::set<std::uint32_t> used;
  for (const Triangle& triangle : soup.triangles) {
    for (const std::uint32_t vertex : graph.corners(triangle)) used.insert(vertex);
  }
  std::uint64_t count = 0;
  for (const Edge& edge : graph.edges) {
    count += static_cast<std::uint64_t>(std::ranges::count_if(
        used, [&](std::uint32_t v) { return inside_edge(soup.points[edge.a], soup.points[edge.b], soup.points[v]); }));
  }
  return count;
}

void check_counts(const Soup& soup, const EdgeGraph& graph, const Diagnosis& diagnosis) {
  std::uint64_t boundary = 0, non_manifold = 0, inconsistent = 0, zero_area = 0, duplicate = 0, opposite = 0;
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    const auto around = graph.around(e);
    boundary += around.size() == 1;
    non_manifold += around.size() > 2;
    inconsistent += around.size() == 2 && around[0].reversed == around[1].reversed;
  }
  std::map<std::set<std::uint32_t>, std::array<std::uint64_t, 2>> faces;  // how often wound one way and the other way
  std::set<std::uint32_t> used;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    Triangle c = graph.corners(soup.triangles[t]);
    used.insert(c.begin(), c.end());
    zero_area += graph.kind[t] != TriangleKind::proper;
    if (graph.kind[t] == TriangleKind::repeated) continue;
    std::rotate(c.begin(), std::ranges::min_element(c), c.end());
    ++faces[{c[0], c[1], c[2]}][c[1] < c[2] ? 0 : 1];
  }
  for (const auto& [corners, wound] : faces) {
    for (const std::uint64_t count : wound) duplicate += count > 0 ? count - 1 : 0;
    opposite += std::min(wound[0], wound[1]);
  }
  const auto agree = [](const char* what, std::uint64_t found, std::uint64_t known) {
    PENUMBRA_ASSERT(found == known, "{}: {}, not {}", what, found, known);
  };
  agree("vertices", diagnosis.vertices, used.size());
  agree("boundary edges", diagnosis.boundary_edges.count, boundary);
  agree("non-manifold edges", diagnosis.non_manifold_edges.count, non_manifold);
  agree("inconsistent windings", diagnosis.inconsistent_windings.count, inconsistent);
  agree("zero-area triangles", diagnosis.zero_area_triangles.count, zero_area);
  agree("duplicate faces", diagnosis.duplicate_faces.count, duplicate);
  agree("opposite faces", diagnosis.opposite_faces.count, opposite);
  agree("silent intersections", diagnosis.self_intersections ? 1 : 0, 1);
  if (!soup.lattice) return;
  agree("T-junctions", diagnosis.t_junctions.count, t_junctions_by_brute_force(soup, graph));
  agree("closed as wound", diagnosis.closed_as_wound, closed_by_brute_force(soup, graph));
}

/// Returns the counts that must not change with the order of triangles, with their first corners, or when all triangles
/// are turned over.
std::array<std::uint64_t, 14> shape_of(const Diagnosis& d) {
  return {d.vertices,
          d.components,
          d.closed,
          d.boundary_edges.count,
          d.boundary_loops,
          d.non_manifold_edges.count,
          d.non_manifold_vertices.count,
          d.inconsistent_windings.count,
          d.duplicate_faces.count,
          d.opposite_faces.count,
          d.zero_area_triangles.count,
          d.needles.count,
          d.t_junctions.count,
          d.self_intersections->count};
}

void check_turned(const Soup& soup, const Diagnosis& diagnosis) {
  Soup turned = soup;
  std::ranges::reverse(turned.triangles);
  for (std::size_t t = 0; t < turned.triangles.size(); ++t) {
    Triangle& c = turned.triangles[t];
    std::rotate(c.begin(), c.begin() + static_cast<long>(t % 3), c.end());
    std::swap(c[0], c[2]);  // all of them: neighbours wound alike stay so, and no others become so
  }
  const Diagnosis other = diagnose(turned.view());
  PENUMBRA_ASSERT(shape_of(other) == shape_of(diagnosis), "turned triangles have another diagnosis");
  PENUMBRA_ASSERT(other.closed_as_wound == diagnosis.closed_as_wound, "turned all alike");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes({data, size});
  const std::array<std::uint8_t, 8> hull = bytes.take<std::array<std::uint8_t, 8>>();
  const Soup soup = make_soup(bytes);
  const EdgeGraph graph = build_edge_graph(soup.view());
  check_graph(soup, graph);
  Bytes hull_bytes(hull);
  if (soup.lattice) check_silhouettes(soup, graph, hull_bytes);
  const Diagnosis diagnosis = diagnose(soup.view());
  check_counts(soup, graph, diagnosis);
  check_turned(soup, diagnosis);
  return 0;
}
