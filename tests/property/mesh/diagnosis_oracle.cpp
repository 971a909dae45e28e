// SPDX-License-Identifier: Apache-2.0
#include "tests/property/mesh/diagnosis_oracle.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

namespace penumbra::mesh::oracle {
namespace {

Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
std::int64_t dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
bool on_line(const Point& a, const Point& b, const Point& p) {
  return cross(b - a, p - a) == Point{};
}

bool repeats(const Corners& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}
Segment edge(const Corners& t, std::size_t i) {
  const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
  return {a, b};
}
bool has_corner(const Corners& t, const Point& p) {
  return std::ranges::find(t, p) != t.end();
}
bool has_edge(const Corners& t, const Segment& e) {
  return has_corner(t, e.first) && has_corner(t, e.second);
}
/// Returns whether the triangle's winding follows the edge from its first end to its second.
bool runs_along(const Corners& t, const Segment& e) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (t[i] == e.first) return t[(i + 1) % 3] == e.second;
  }
  return false;
}
Corners sorted(Corners t) {
  std::ranges::sort(t);
  return t;
}
Corners reversed(const Corners& t) {
  return {t[0], t[2], t[1]};
}
/// Returns a key of t that does not depend on its first corner, but does depend on its winding.
Corners rotated(Corners t) {
  std::rotate(t.begin(), std::ranges::min_element(t), t.end());
  return t;
}

using Linked = std::function<bool(std::size_t, std::size_t)>;

/// Divides the numbers below `count` into sets: linked numbers share a set. Returns for each number the smallest number
/// of its set.
std::vector<std::size_t> sets(std::size_t count, const Linked& linked) {
  std::vector<std::size_t> set(count, count);
  const std::function<void(std::size_t, std::size_t)> flood = [&](std::size_t i, std::size_t name) {
    if (set[i] != count) return;
    set[i] = name;
    for (std::size_t j = 0; j < count; ++j) {
      if (j != i && linked(i, j)) flood(j, name);
    }
  };
  for (std::size_t i = 0; i < count; ++i) flood(i, i);
  return set;
}
std::uint64_t count_sets(std::size_t count, const Linked& linked) {
  const std::vector<std::size_t> set = sets(count, linked);
  return std::set(set.begin(), set.end()).size();
}

using Around = std::map<Segment, std::vector<std::size_t>>;

/// Returns the triangles at vertex v in sets: triangles that share an edge at v are linked.
std::vector<std::size_t> fans_at(const std::vector<Corners>& soup, const Point& v) {
  return sets(soup.size(), [&](std::size_t i, std::size_t j) {
    if (!has_corner(soup[i], v) || !has_corner(soup[j], v)) return false;
    return std::ranges::any_of(soup[i], [&](const Point& p) { return p != v && has_corner(soup[j], p); });
  });
}

std::uint64_t count_boundary_loops(const std::vector<Corners>& soup, const Around& around) {
  std::vector<std::pair<Segment, std::size_t>> boundary;  // with the triangle at each edge
  for (const auto& [e, triangles] : around) {
    if (triangles.size() == 1) boundary.emplace_back(e, triangles[0]);
  }
  return count_sets(boundary.size(), [&](std::size_t i, std::size_t j) {
    const auto& [e, t] = boundary[i];
    const auto& [f, u] = boundary[j];
    for (const Point& v : {e.first, e.second}) {
      if (v != f.first && v != f.second) continue;
      const std::vector<std::size_t> fans = fans_at(soup, v);
      if (fans[t] == fans[u]) return true;
    }
    return false;
  });
}

/// Returns the soup with neighbours wound alike. Most triangles of each patch keep their winding (if equally many would
/// be turned either way, the triangle that is first in space keeps its winding); if a patch cannot be wound alike, all
/// of its triangles keep theirs.
std::vector<Corners> agreeing(const std::vector<Corners>& soup, const Around& around) {
  std::vector<std::vector<std::pair<std::size_t, bool>>> neighbours(
      soup.size());  // the neighbour, and whether the two are wound against each other
  for (const auto& [e, triangles] : around) {
    if (triangles.size() != 2 || sorted(soup[triangles[0]]) == sorted(soup[triangles[1]])) continue;
    const bool against = runs_along(soup[triangles[0]], e) == runs_along(soup[triangles[1]], e);
    neighbours[triangles[0]].push_back({triangles[1], against});
    neighbours[triangles[1]].push_back({triangles[0], against});
  }
  std::vector<Corners> result = soup;
  std::vector<bool> seen(soup.size());
  for (std::size_t seed = 0; seed < soup.size(); ++seed) {
    if (seen[seed]) continue;
    std::map<std::size_t, bool> turned;
    bool possible = true;
    const std::function<void(std::size_t, bool)> visit = [&](std::size_t t, bool turn) {
      seen[t] = true;
      const auto [known, fresh] = turned.insert({t, turn});
      if (!fresh) {
        possible = possible && known->second == turn;
        return;
      }
      for (const auto& [u, against] : neighbours[t]) visit(u, turn != against);
    };
    visit(seed, false);
    if (!possible) continue;
    const auto count = static_cast<std::size_t>(std::ranges::count_if(turned, [](const auto& t) { return t.second; }));
    const auto first =
        std::ranges::min_element(turned, {}, [&](const auto& t) { return std::pair(sorted(soup[t.first]), t.first); });
    const bool back = 2 * count == turned.size() ? first->second : 2 * count > turned.size();
    for (const auto& [t, turn] : turned) {
      if (turn != back) result[t] = reversed(soup[t]);
    }
  }
  return result;
}

/// Returns whether winding numbers at random points among the triangles are integers. Each of n solid angles is off by
/// about 1e-15 unless the point is close to the triangle's plane, which 20 random points are not; winding numbers of an
/// open mesh are integers almost nowhere.
bool integer_windings(const std::vector<Corners>& soup) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> anywhere(-1, 9);
  for (int i = 0; i < 20; ++i) {
    const double w = winding_number(soup, {anywhere(random), anywhere(random), anywhere(random)});
    if (std::abs(w - std::round(w)) > 1e-9) return false;
  }
  return true;
}

}  // namespace

double winding_number(const std::vector<Corners>& soup, const glm::dvec3& q) {
  double sum = 0;
  for (const Corners& t : soup) {
    std::array<glm::dvec3, 3> r;
    for (std::size_t i = 0; i < 3; ++i) r[i] = glm::dvec3(t[i].x, t[i].y, t[i].z) - q;
    const double a = glm::length(r[0]), b = glm::length(r[1]), c = glm::length(r[2]);
    const double numerator = glm::dot(r[0], glm::cross(r[1], r[2]));
    const double denominator =
        a * b * c + glm::dot(r[0], r[1]) * c + glm::dot(r[1], r[2]) * a + glm::dot(r[2], r[0]) * b;
    sum += 2 * std::atan2(numerator, denominator);
  }
  return sum / (4 * std::numbers::pi);
}

Counts count(const std::vector<Corners>& all) {
  Counts counts;
  std::set<Point> vertices;
  std::vector<Corners> soup;  // without triangles that repeat a vertex
  for (const Corners& t : all) {
    vertices.insert(t.begin(), t.end());
    if (repeats(t) || on_line(t[0], t[1], t[2])) ++counts.zero_area_triangles;
    if (!repeats(t)) soup.push_back(t);
  }
  Around around;
  for (std::size_t t = 0; t < soup.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) around[edge(soup[t], i)].push_back(t);
  }
  counts.vertices = vertices.size();
  counts.components = count_sets(soup.size(), [&](std::size_t i, std::size_t j) {
    return has_edge(soup[i], edge(soup[j], 0)) || has_edge(soup[i], edge(soup[j], 1)) ||
           has_edge(soup[i], edge(soup[j], 2));
  });
  for (const auto& [e, triangles] : around) {
    if (triangles.size() == 1) ++counts.boundary_edges;
    if (triangles.size() > 2) ++counts.non_manifold_edges;
    if (triangles.size() == 2 && runs_along(soup[triangles[0]], e) == runs_along(soup[triangles[1]], e)) {
      ++counts.inconsistent_windings;
    }
    for (const Point& p : vertices) {
      const std::int64_t along = dot(p - e.first, e.second - e.first);
      const bool inside = along > 0 && along < dot(e.second - e.first, e.second - e.first);
      if (inside && on_line(e.first, e.second, p)) ++counts.t_junctions;
    }
  }
  counts.boundary_loops = count_boundary_loops(soup, around);
  for (const Point& v : vertices) {
    const std::vector<std::size_t> fans = fans_at(soup, v);
    std::set<std::size_t> different;
    for (std::size_t t = 0; t < soup.size(); ++t) {
      if (has_corner(soup[t], v)) different.insert(fans[t]);
    }
    if (different.size() > 1) ++counts.non_manifold_vertices;
  }
  std::map<Corners, std::uint64_t> wound;
  for (const Corners& t : soup) ++wound[rotated(t)];
  for (const auto& [t, times] : wound) {
    counts.duplicate_faces += times - 1;
    const auto other = wound.find(rotated(reversed(t)));
    if (other != wound.end() && t < other->first) counts.opposite_faces += std::min(times, other->second);
  }
  counts.closed_as_wound = integer_windings(soup);
  counts.closed = integer_windings(agreeing(soup, around));
  return counts;
}

Counts counts_of(const Diagnosis& d) {
  return {d.vertices,
          d.components,
          d.boundary_edges.count,
          d.boundary_loops,
          d.non_manifold_edges.count,
          d.non_manifold_vertices.count,
          d.inconsistent_windings.count,
          d.duplicate_faces.count,
          d.opposite_faces.count,
          d.zero_area_triangles.count,
          d.t_junctions.count,
          d.closed,
          d.closed_as_wound};
}

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << "vertices " << c.vertices << ", components " << c.components << ", boundary " << c.boundary_edges
             << " in loops " << c.boundary_loops << ", non-manifold edges " << c.non_manifold_edges << " vertices "
             << c.non_manifold_vertices << ", inconsistent " << c.inconsistent_windings << ", duplicate "
             << c.duplicate_faces << ", opposite " << c.opposite_faces << ", zero area " << c.zero_area_triangles
             << ", T-junctions " << c.t_junctions << ", closed " << c.closed << ", as wound " << c.closed_as_wound;
}

std::uint64_t count_self_intersections(const std::vector<Corners>& soup) {
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  const auto point = [](const Point& p) {
    return Kernel::Point_3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  };
  const auto meet_elsewhere = [&](const Corners& t, const Corners& u) {
    const auto common = CGAL::intersection(Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2])),
                                           Kernel::Triangle_3(point(u[0]), point(u[1]), point(u[2])));
    if (!common) return false;
    std::vector<Kernel::Point_3> shared;
    for (const Point& p : t) {
      if (has_corner(u, p)) shared.push_back(point(p));
    }
    if (const auto* at = boost::get<Kernel::Point_3>(&*common)) return std::ranges::find(shared, *at) == shared.end();
    const auto* along = boost::get<Kernel::Segment_3>(&*common);
    if (along == nullptr || shared.size() != 2) return true;
    const Kernel::Segment_3 edge(shared[0], shared[1]);
    return !edge.has_on(along->source()) || !edge.has_on(along->target());
  };
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < soup.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool proper = !on_line(soup[i][0], soup[i][1], soup[i][2]) && !on_line(soup[j][0], soup[j][1], soup[j][2]);
      if (proper && meet_elsewhere(soup[i], soup[j])) ++count;
    }
  }
  return count;
}

}  // namespace penumbra::mesh::oracle
