#pragma once

#include "areas/light_region.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

// Inside areas/ only: triangles as seen from a view sample p on the light's plane, exactly.
//
// With r = p − c and d = q − p the line from p through q meets the light's plane c + s u + t v at s = S/W, t = T/W:
//     S = −det(r, v, d)    T = −det(u, r, d)    W = −det(u, v, d)    (all negated if p is behind the plane, so that
// W > 0 for what lies toward the light). All three are linear in q; W is 0 on the plane through p that is parallel to
// the light and K = det(u, v, r) on the light. q can hide something only where 0 < W < K.

namespace penumbra::areas {

/// A point of a clipped triangle: (S, T, W) times m, and m > 0. One more coordinate, and no division.
struct ProjectivePoint {
  mpz_class s, t, w, m;
};

using ProjectiveEdge = std::pair<ProjectivePoint, ProjectivePoint>;
using Polygon = std::vector<ProjectivePoint>;

/// What a triangle is clipped by, in this order. Left and right leave only W ≥ 0, and W = 0 only at p itself.
enum class ClipPlane : std::uint8_t { light, left, right, bottom, top };
constexpr std::size_t kClipPlanes = 5;
constexpr unsigned bit_of(ClipPlane plane) {
  return 1u << static_cast<unsigned>(plane);
}
constexpr unsigned kAllClipPlanes = (1u << kClipPlanes) - 1;

/// A light's stored points, whose differences integers hold exactly (visibility::LightFrame rounds them), and the grid
/// that has them all: what view samples share. Only a sphere's depends on p. Of a sun c is the way from any p to its
/// middle: r = −c, and whatever has W > 0 can hide something.
struct IntegerFrame {
  glm::dvec3 c{0}, u_end{0}, v_end{0};  ///< u = u_end − origin: c, as stored, or for a sphere, whose axes are given, 0
  glm::dvec3 origin{0};
  IntegerGrid grid;      ///< of all these
  bool endless = false;  ///< a sun
};
IntegerFrame integer_frame(const visibility::Light& light, const glm::vec3& p);

/// One view sample's projection. `grid` makes integers of p, the frame and every vertex.
class BackProjection {
 public:
  BackProjection(const IntegerFrame& frame, const IntegerGrid& grid, const glm::vec3& p);

  /// Is p exactly on the light's plane? (Then nothing can be projected.)
  [[nodiscard]] bool on_plane() const { return reach_ == 0; }
  /// Is p behind the light's plane? (Then what is counter-clockwise as seen from p is clockwise in s and t.)
  [[nodiscard]] bool mirrored() const { return mirrored_; }
  /// The part of the plane that counts. Needed before what follows.
  void set_box(const GridBox& box) { box_ = box; }

  [[nodiscard]] ProjectivePoint project(const glm::vec3& q) const;
  /// ≥ 0: on the plane's inner side. Exact.
  [[nodiscard]] mpz_class height(ClipPlane plane, const ProjectivePoint& q) const;
  /// What of the edge is on the inner side of all `planes` (bits); nothing if that is a point or less.
  [[nodiscard]] std::optional<ProjectiveEdge> clip_edge(ProjectiveEdge edge, unsigned planes) const;
  /// What of a convex polygon is on the inner side. `cut` is the edge that closes it along the plane, if it was cut;
  /// also if only its boundary is inside, so that what is left always is a closed polygon.
  [[nodiscard]] Polygon clip_polygon(const Polygon& polygon, ClipPlane plane, std::optional<ProjectiveEdge>& cut) const;
  /// The height over the plane (a, b, c) of the points of the light: det(b − a, c − a, l − a), times `sign`.
  [[nodiscard]] HalfPlane above_plane(const std::array<glm::vec3, 3>& corners, int sign) const;

 private:
  using Integers = std::array<mpz_class, 3>;

  IntegerGrid grid_;
  Integers p_, c_, u_, v_;       ///< c: of a sun a way
  Integers to_s_, to_t_, to_w_;  ///< S, T, W are their products with q − p
  mpz_class reach_;              ///< K, made positive
  bool mirrored_ = false, endless_ = false;
  GridBox box_;
};

/// a · |height of b| + b · |height of a|: where the edge from a to b, on different sides of a plane, crosses it.
ProjectivePoint crossing(const ProjectivePoint& a, const mpz_class& height_a, const ProjectivePoint& b,
                         const mpz_class& height_b);

}  // namespace penumbra::areas
