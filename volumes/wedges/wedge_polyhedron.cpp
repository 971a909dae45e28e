// SPDX-License-Identifier: Apache-2.0
// Clips the box by one half-space after another (Sutherland and Hodgman, on all faces at once): corners beyond the
// half-space are removed, edges that cross its plane get a corner shared by both their faces, and the new face is the
// loop of the edges left on the plane.

#include "volumes/wedges/wedge_polyhedron.hpp"

#include "base/assert.hpp"
#include "volumes/wedges/planar.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace penumbra::volumes {
namespace {

using Vector = std::array<mpq_class, 3>;

Vector difference(const ExactPoint& p, const ExactPoint& q) {
  return {p.at[0] - q.at[0], p.at[1] - q.at[1], p.at[2] - q.at[2]};
}

Vector cross(const Vector& u, const Vector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Returns the largest coordinate of a face's corners.
double size_of(const Polyhedron& polyhedron, const PolyhedronFace& face) {
  double size = 0;
  for (const std::uint32_t corner : face.loop) size = std::max(size, largest(polyhedron.corners[corner].near));
  return size;
}

/// Returns twice the area of a loop as a vector along the loop's normal, by a fan.
Vector face_area(const Polyhedron& polyhedron, const PolyhedronFace& face) {
  Vector sum{0, 0, 0};
  const ExactPoint& first = polyhedron.corners[face.loop[0]];
  for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
    const Vector part = cross(difference(polyhedron.corners[face.loop[i]], first),
                              difference(polyhedron.corners[face.loop[i + 1]], first));
    for (std::size_t k = 0; k < 3; ++k) sum[k] += part[k];
  }
  return sum;
}

/// Returns whether the loop runs clockwise as seen from the side that the plane's normal points to. Decided in double
/// where that is certain: with M the largest coordinate, differences are off by 6 · 2⁻⁵³ M and at most 2 M; so a
/// coordinate of a triangle's area, which has two products, is off by less than 2⁻⁴⁶ M².
bool runs_outward(const Polyhedron& polyhedron, const PolyhedronFace& face) {
  glm::dvec3 sum(0);
  const glm::dvec3& first = polyhedron.corners[face.loop[0]].near;
  for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
    sum += glm::cross(polyhedron.corners[face.loop[i]].near - first, polyhedron.corners[face.loop[i + 1]].near - first);
  }
  const glm::dvec3 n = face.plane.normal();
  const double value = glm::dot(sum, n), size = size_of(polyhedron, face);
  const double error = 0x1p-44 * static_cast<double>(face.loop.size()) * size * size * largest(n);
  if (std::abs(value) > error) return value < 0;
  const Vector area = face_area(polyhedron, face);
  return sgn(mpq_class(area[0] * mpq_class(n.x) + area[1] * mpq_class(n.y) + area[2] * mpq_class(n.z))) < 0;
}

/// Returns whether the triangle has an area. Decided in double where that is certain, with the bound of runs_outward.
bool has_area(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  const double size = std::max({largest(a.near), largest(b.near), largest(c.near)});
  if (largest(glm::cross(b.near - a.near, c.near - a.near)) > 0x1p-45 * size * size) return true;
  const Vector normal = cross(difference(b, a), difference(c, a));
  return std::ranges::any_of(normal, [](const mpq_class& x) { return sgn(x) != 0; });
}

Polyhedron box_mesh(const Box& box) {
  Polyhedron mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.corners.emplace_back(glm::dvec3((i & 1) != 0 ? box.upper.x : box.lower.x,
                                         (i & 2) != 0 ? box.upper.y : box.lower.y,
                                         (i & 4) != 0 ? box.upper.z : box.lower.z));
  }
  const auto &low = box.lower, &high = box.upper;
  mesh.faces = {{{1, 0, 0, -low.x}, {0, 4, 6, 2}}, {{-1, 0, 0, high.x}, {1, 3, 7, 5}},
                {{0, 1, 0, -low.y}, {0, 1, 5, 4}}, {{0, -1, 0, high.y}, {2, 6, 7, 3}},
                {{0, 0, 1, -low.z}, {0, 2, 3, 1}}, {{0, 0, -1, high.z}, {4, 5, 7, 6}}};
  return mesh;
}

class Cut {
 public:
  Cut(Polyhedron& mesh, const Plane& plane) : mesh_(mesh), plane_(plane) {
    for (const ExactPoint& corner : mesh.corners) sides_.push_back(side_of(plane, corner));
  }

  void apply() {
    const bool above = std::ranges::find(sides_, 1) != sides_.end(), on = std::ranges::find(sides_, 0) != sides_.end();
    if (!above) {
      mesh_ = {on ? Extent::flat : Extent::empty, {}, {}};
      return;
    }
    if (std::ranges::find(sides_, -1) == sides_.end()) return;
    std::vector<PolyhedronFace> kept;
    for (const PolyhedronFace& face : mesh_.faces) {
      PolyhedronFace part{face.plane, part_above(face.loop)};
      if (part.loop.size() >= 3) kept.push_back(std::move(part));
    }
    kept.push_back({plane_, lid(kept)});
    mesh_.faces = std::move(kept);
    drop_unused();
  }

 private:
  std::vector<std::uint32_t> part_above(const std::vector<std::uint32_t>& loop) {
    std::vector<std::uint32_t> part;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
      if (sides_[from] >= 0) part.push_back(from);
      if (sides_[from] * sides_[to] < 0) part.push_back(crossing(from, to));
    }
    return part;
  }

  std::uint32_t crossing(std::uint32_t from, std::uint32_t to) {
    const auto [entry, is_new] =
        crossings_.try_emplace(std::minmax(from, to), static_cast<std::uint32_t>(mesh_.corners.size()));
    if (!is_new) return entry->second;
    const ExactPoint &p = mesh_.corners[from], &q = mesh_.corners[to];
    const mpq_class at_p = height_of(plane_, p), share = at_p / (at_p - height_of(plane_, q));
    Vector at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = p.at[k] + share * (q.at[k] - p.at[k]);
    mesh_.corners.emplace_back(std::move(at));
    sides_.push_back(0);
    return entry->second;
  }

  /// Returns the loop of edges on the plane, in the direction opposite to that of the faces that end there.
  [[nodiscard]] std::vector<std::uint32_t> lid(const std::vector<PolyhedronFace>& faces) const {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const PolyhedronFace& face : faces) {
      for (std::size_t i = 0; i < face.loop.size(); ++i) {
        const std::uint32_t from = face.loop[i], to = face.loop[(i + 1) % face.loop.size()];
        if (sides_[from] == 0 && sides_[to] == 0) next[to] = from;
      }
    }
    PENUMBRA_ASSERT(next.size() >= 3, "{} edges lie on the cutting plane", next.size());
    std::vector<std::uint32_t> loop;
    for (std::uint32_t at = next.begin()->first; loop.size() < next.size(); at = next.at(at)) loop.push_back(at);
    return loop;
  }

  void drop_unused() {
    std::vector<std::uint32_t> place(mesh_.corners.size(), 0);
    for (const PolyhedronFace& face : mesh_.faces) {
      for (const std::uint32_t corner : face.loop) place[corner] = 1;
    }
    std::vector<ExactPoint> used;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (place[i] == 0) continue;
      place[i] = static_cast<std::uint32_t>(used.size());
      used.push_back(std::move(mesh_.corners[i]));
    }
    mesh_.corners = std::move(used);
    for (PolyhedronFace& face : mesh_.faces) {
      for (std::uint32_t& corner : face.loop) corner = place[corner];
    }
  }

  Polyhedron& mesh_;
  const Plane& plane_;
  std::vector<int> sides_;  // the side that each corner is on
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings_;
};

}  // namespace

ExactPoint::ExactPoint(const glm::dvec3& p) : at{mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)}, near(p) {}

ExactPoint::ExactPoint(std::array<mpq_class, 3> exact)
    : at(std::move(exact)), near(at[0].get_d(), at[1].get_d(), at[2].get_d()) {}

mpq_class height_of(const Plane& plane, const ExactPoint& p) {
  return mpq_class(plane.a) * p.at[0] + mpq_class(plane.b) * p.at[1] + mpq_class(plane.c) * p.at[2] +
         mpq_class(plane.d);
}

int side_of(const Plane& plane, const ExactPoint& p) {
  const double x = plane.a * p.near.x, y = plane.b * p.near.y, z = plane.c * p.near.z;
  const double size = std::abs(x) + std::abs(y) + std::abs(z) + std::abs(plane.d), value = x + y + z + plane.d;
  // Corners are off by 2⁻⁵²; the product and three sums add 4 · 2⁻⁵³: below 2⁻⁵⁰ in all.
  if (std::abs(value) > 0x1p-50 * size + std::numeric_limits<double>::min()) return value > 0 ? 1 : -1;
  return sgn(height_of(plane, p));
}

int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& p) {
  const glm::dvec3 u = b.near - a.near, v = c.near - a.near, w = p.near - a.near;
  const double value = glm::dot(glm::cross(u, v), w);
  // With M the largest coordinate: coordinates are off by 2⁻⁵² M each, differences (below 2 M) by less than 6 · 2⁻⁵³ M
  // = 2⁻⁵⁰·⁴ of their bound. A product of three is off by three times this error and 5 roundings. There are six
  // products of at most 8 M³: below 48 · 2⁻⁴⁸ M³.
  const double size = std::max({largest(a.near), largest(b.near), largest(c.near), largest(p.near)});
  if (std::abs(value) > 0x1p-42 * size * size * size) return value > 0 ? 1 : -1;
  const Vector normal = cross(difference(b, a), difference(c, a)), direction = difference(p, a);
  return sgn(mpq_class(normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2]));
}

Polyhedron cut_box(const Box& box, std::span<const Plane> planes) {
  Polyhedron mesh = box_mesh(box);
  for (const Plane& plane : planes) {
    if (mesh.extent == Extent::solid) Cut(mesh, plane).apply();
  }
  return mesh;
}

std::optional<std::string> flaw_of(const Polyhedron& polyhedron) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const PolyhedronFace& face : polyhedron.faces) {
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      const auto edge = std::pair(face.loop[i], face.loop[(i + 1) % face.loop.size()]);
      if (!edges.insert(edge).second)
        return fmt::format("edge {} {} occurs twice in the same direction", edge.first, edge.second);
    }
  }
  for (const auto& [from, to] : edges) {
    if (!edges.contains({to, from})) return fmt::format("edge {} {} has one face only", from, to);
  }
  if (polyhedron.corners.size() + polyhedron.faces.size() != edges.size() / 2 + 2) {
    return fmt::format("{} corners, {} edges and {} faces do not form a closed surface like a sphere (V - E + F = 2)",
                       polyhedron.corners.size(), edges.size() / 2, polyhedron.faces.size());
  }
  for (const PolyhedronFace& face : polyhedron.faces) {
    if (!runs_outward(polyhedron, face)) return "a face does not run counter-clockwise seen from outside";
    for (const ExactPoint& corner : polyhedron.corners) {
      if (side_of(face.plane, corner) < 0) return "a corner lies outside a face";
    }
    for (const std::uint32_t corner : face.loop) {
      if (side_of(face.plane, polyhedron.corners[corner]) != 0) return "a face's corner is not on its plane";
    }
  }
  return std::nullopt;
}

bool mesh_holds(const Polyhedron& polyhedron, const glm::dvec3& p) {
  const ExactPoint point(p);
  return std::ranges::all_of(polyhedron.faces, [&](const PolyhedronFace& face) {
    // Uses the first triangle of the fan that has an area: a corner may lie on the segment between its neighbours.
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
      const ExactPoint &a = polyhedron.corners[face.loop[0]], &b = polyhedron.corners[face.loop[i]],
                       &c = polyhedron.corners[face.loop[i + 1]];
      if (!has_area(a, b, c)) continue;
      return orientation(a, b, c, point) <= 0;
    }
    return false;
  });
}

}  // namespace penumbra::volumes
