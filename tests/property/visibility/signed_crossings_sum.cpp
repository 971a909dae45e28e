// SPDX-License-Identifier: Apache-2.0
// Depth complexity from signed edges (Laine et al. 2005; for any soup: ours), exact. It is derived in
// docs/signed-crossings.md, whose sections the comments name in parentheses. It works on the edges that scatter methods
// would project onto the light; tests compare methods in floats with it.

#include "tests/property/visibility/signed_crossings_sum.hpp"

#include "base/assert.hpp"
#include "mesh/silhouettes.hpp"

#include <CGAL/MP_Float.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::visibility {
namespace {

using mesh::Side;
using Exact = CGAL::MP_Float;  // every sum, difference and product of doubles, without rounding

struct WideVector {
  Exact x, y, z;
};

template <typename Vector>
WideVector difference(const Vector& to, const Vector& from) {
  const auto one = [](double a, double b) { return Exact(a) - Exact(b); };
  return {one(to.x, from.x), one(to.y, from.y), one(to.z, from.z)};
}

WideVector wide_cross(const WideVector& a, const WideVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Exact wide_dot(const WideVector& a, const WideVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

int sign(const Exact& value) {
  return static_cast<int>(CGAL::sign(value));
}

/// A point as p sees it: x − p = (S u + T v + W (l − p)) / scale, scale > 0. The light point is (0, 0, 1), the ray from
/// it along u is T = 0 < S; W = 0 on p's plane, W = scale on the light's plane. (Coordinates)
struct Seen {
  Exact s, t, w;
};

/// The map x ↦ (S, T, W), scaled by |det[u, v, l − p]|.
class Frame {
 public:
  Frame(const CrossingPair& pair, const Light& light) : p_(pair.p) {
    const WideVector u = difference(light.center_u, light.center), v = difference(light.center_v, light.center);
    const WideVector towards = difference(pair.l, pair.p);
    row_s_ = wide_cross(v, towards);
    row_t_ = wide_cross(towards, u);
    row_w_ = wide_cross(u, v);
    light_w_ = wide_dot(row_w_, towards);
    handedness_ = sign(light_w_);
    if (handedness_ < 0) light_w_ = -light_w_;
  }

  [[nodiscard]] int handedness() const { return handedness_; }  ///< the sign of det[u, v, l − p]
  [[nodiscard]] const Exact& light_w() const { return light_w_; }

  [[nodiscard]] Seen see(const glm::dvec3& x) const {
    const WideVector d = difference(x, glm::dvec3(p_));
    Seen seen{wide_dot(row_s_, d), wide_dot(row_t_, d), wide_dot(row_w_, d)};
    return handedness_ < 0 ? Seen{-seen.s, -seen.t, -seen.w} : seen;
  }

 private:
  glm::vec3 p_;
  WideVector row_s_, row_t_, row_w_;
  Exact light_w_;
  int handedness_ = 0;
};

/// Place of a point along the slab; a point on a bounding plane is outside.
enum class Place { at_p_or_behind, between, at_light_or_beyond };

struct Corner {
  Seen seen;
  Place place = Place::between;
};

Corner place_corner(const Frame& frame, const glm::dvec3& x) {
  Corner corner{frame.see(x), Place::between};
  if (sign(corner.seen.w) <= 0) corner.place = Place::at_p_or_behind;
  if (corner.seen.w >= frame.light_w()) corner.place = Place::at_light_or_beyond;
  return corner;
}

/// Returns a positive multiple of the point where the edge a→b passes the height `w`, which lies between the heights of
/// a and b.
Seen cut(const Seen& a, const Seen& b, const Exact& w) {
  const Exact of_a = b.w - w, of_b = w - a.w;
  Seen seen{of_a * a.s + of_b * b.s, of_a * a.t + of_b * b.t, of_a * a.w + of_b * b.w};
  return b.w < a.w ? Seen{-seen.s, -seen.t, -seen.w} : seen;
}

/// The end of a clipped edge, and whether it counts as above the line of the ray. (Ties: T)
struct End {
  Seen seen;
  bool above = false;
};

/// Returns the clipped edge's end on the side of `from`.
End end_towards(const Corner& from, const Corner& other, const Frame& frame) {
  if (from.place == Place::between) return {from.seen, sign(from.seen.t) > 0};
  End end{cut(from.seen, other.seen, from.place == Place::at_p_or_behind ? Exact(0) : frame.light_w()), false};
  const int t = sign(end.seen.t);
  end.above = t != 0 ? t > 0 : sign(other.seen.t) > 0;
  return end;
}

bool enters_slab(const Corner& a, const Corner& b) {
  return a.place != b.place || a.place == Place::between;
}

/// An edge from one side of the ray's line to the other, with the light point on its left (`left` > 0) or right (< 0),
/// crosses the ray itself upwards (+1), downwards (−1) or not (0). If the light point is on the edge (0), it does not:
/// the moved light point l + ε·u is beyond the edge. (Ties: E)
int crossing(bool from_above, bool to_above, int left) {
  if (from_above == to_above) return 0;
  return to_above ? (left > 0 ? 1 : 0) : (left < 0 ? -1 : 0);
}

/// Returns the sign of det[light point, a, b]: the side of a→b on which the light point lies.
int light_on_left(const Seen& a, const Seen& b) {
  return sign(a.s * b.t - b.s * a.t);
}

int edge_crossing(const Corner& a, const Corner& b, const Frame& frame) {
  if (!enters_slab(a, b)) return 0;
  const bool from_above = end_towards(a, b, frame).above, to_above = end_towards(b, a, frame).above;
  if (from_above == to_above) return 0;
  return crossing(from_above, to_above, light_on_left(a.seen, b.seen));
}

/// Returns one plane's cut edge of a triangle wound as in `corners`: from the point where the boundary leaves the slab
/// through the plane to the point where it comes back.
std::optional<std::pair<End, End>> cut_edge(const std::array<Corner, 3>& corners, Place outside, const Frame& frame) {
  std::optional<End> leaves, returns;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.place == b.place) continue;
    if (b.place == outside) leaves = end_towards(b, a, frame);
    if (a.place == outside) returns = end_towards(a, b, frame);
  }
  if (!leaves) return std::nullopt;
  return std::pair{*leaves, *returns};
}

/// `winding` is the sign of the corners' determinant as seen: > 0 where they run counter-clockwise around the inside.
int cut_crossing(const std::array<Corner, 3>& corners, Place outside, int winding, const Frame& frame) {
  const auto edge = cut_edge(corners, outside, frame);
  if (!edge) return 0;
  const auto& [from, to] = *edge;
  if (from.above == to.above) return 0;
  int left = light_on_left(from.seen, to.seen);
  if (left == 0) {  // (Ties: cut edges)
    const int at = sign(from.seen.s);
    const bool one_corner = sign(from.seen.t) == 0 && sign(to.seen.t) == 0 && at != 0 && at == sign(to.seen.s) &&
                            from.seen.s * to.seen.w == to.seen.s * from.seen.w;
    left = one_corner ? (to.above ? at : -at) : -winding;
  }
  return crossing(from.above, to.above, left);
}

}  // namespace

SignedCrossings signed_crossings(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph,
                                 std::span<const Side> facings, const CrossingPair& pair, const Light& light) {
  PENUMBRA_ASSERT(light.kind != LightKind::sphere, "light {} has no plane", light.name);
  PENUMBRA_ASSERT(facings.size() == mesh.triangles.size(), "{} facings for {} triangles", facings.size(),
                  mesh.triangles.size());
  const Frame frame(pair, light);
  PENUMBRA_ASSERT(frame.handedness() != 0, "({}, {}, {}) is on the plane through its light point", pair.p.x, pair.p.y,
                  pair.p.z);
  std::vector<Corner> corners(mesh.positions.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (graph.vertex[i] == i) corners[i] = place_corner(frame, mesh.positions[i]);
  }

  SignedCrossings sum;
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    const int multiplicity = mesh::signed_multiplicity(graph, e, facings);
    if (multiplicity == 0) continue;
    sum.edges += multiplicity * edge_crossing(corners[graph.edges[e].a], corners[graph.edges[e].b], frame);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int facing = static_cast<int>(facings[i]);
    if (facing == 0) continue;
    const mesh::Triangle t = graph.corners(mesh.triangles[i]);
    const std::array<Corner, 3> triangle = {corners[t[0]], corners[t[1]], corners[t[2]]};
    const int winding = -frame.handedness() * facing;
    sum.cuts_at_light += facing * cut_crossing(triangle, Place::at_light_or_beyond, winding, frame);
    sum.cuts_at_p += facing * cut_crossing(triangle, Place::at_p_or_behind, winding, frame);
  }
  // Counter-clockwise as seen from p is clockwise in (S, T) where u, v and the view are right-handed. (Sum)
  const int sense = -frame.handedness();
  return {sense * sum.edges, sense * sum.cuts_at_light, sense * sum.cuts_at_p};
}

}  // namespace penumbra::visibility
