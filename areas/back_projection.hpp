// SPDX-License-Identifier: Apache-2.0
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

// Projects triangles exactly, from a view sample p onto the light's plane. Internal to areas/.
//
// With r = p − c and d = q − p the line from p through q meets the light's plane c + s u + t v at s = S/W, t = T/W:
//   S = −det(r, v, d)    T = −det(u, r, d)    W = −det(u, v, d)    (all negated if p is behind the plane, so that
// W > 0 for points toward the light). All three are linear in q; W is 0 on the plane through p that is parallel to the
// light and K = det(u, v, r) on the light. q can hide something only where 0 < W < K.

namespace penumbra::areas {

/// Point of a clipped triangle: (S, T, W) times m, and m > 0. One more coordinate instead of a division.
struct ProjectivePoint {
  mpz_class s, t, w, m;
};

using ProjectiveEdge = std::pair<ProjectivePoint, ProjectivePoint>;
using Polygon = std::vector<ProjectivePoint>;

/// Clip planes of a triangle, in this order. After clipping at left and right only points with W ≥ 0 remain, and W = 0
/// only at p itself.
enum class ClipPlane : std::uint8_t { light, left, right, bottom, top };
constexpr std::size_t kClipPlanes = 5;
constexpr unsigned bit_of(ClipPlane plane) {
  return 1u << static_cast<unsigned>(plane);
}
constexpr unsigned kAllClipPlanes = (1u << kClipPlanes) - 1;

/// Stored points of a light, and the grid that represents them and their differences as exact integers
/// (visibility::LightFrame rounds the differences). All view samples share them, except for a sphere, whose points
/// depend on p. For a sun, c is the direction from any p to the sun's middle: r = −c, and every point with W > 0 can
/// hide something.
struct IntegerFrame {
  glm::dvec3 c{0}, u_end{0}, v_end{0};  ///< u = u_end − origin, v = v_end − origin; origin is the stored c, or 0 for a
                                        ///< sphere, whose axes are given directly
  glm::dvec3 origin{0};
  IntegerGrid grid;      ///< of all these points
  bool endless = false;  ///< a sun
};
IntegerFrame integer_frame(const visibility::Light& light, const glm::vec3& p);

/// Projection of one view sample. `grid` converts p, the frame and every vertex to integers.
class BackProjection {
 public:
  BackProjection(const IntegerFrame& frame, const IntegerGrid& grid, const glm::vec3& p);

  /// Returns whether p is exactly on the light's plane. (Then nothing can be projected.)
  [[nodiscard]] bool on_plane() const { return reach_ == 0; }
  /// Returns whether p is behind the light's plane. (Then counter-clockwise as seen from p is clockwise in s and t.)
  [[nodiscard]] bool mirrored() const { return mirrored_; }
  /// Sets the relevant part of the plane. Required before the following functions.
  void set_box(const GridBox& box) { box_ = box; }

  [[nodiscard]] ProjectivePoint project(const glm::vec3& q) const;
  /// Returns a value ≥ 0 on the plane's inner side. Exact.
  [[nodiscard]] mpz_class height(ClipPlane plane, const ProjectivePoint& q) const;
  /// Returns the part of the edge on the inner side of all `planes` (bits); nullopt if it is a point or empty.
  [[nodiscard]] std::optional<ProjectiveEdge> clip_edge(ProjectiveEdge edge, unsigned planes) const;
  /// Returns the part of a convex polygon on the inner side. `cut` becomes the edge that closes the polygon along the
  /// plane, if the polygon was cut. That includes polygons of which only the boundary is inside, so the result is
  /// always closed.
  [[nodiscard]] Polygon clip_polygon(const Polygon& polygon, ClipPlane plane, std::optional<ProjectiveEdge>& cut) const;
  /// Returns the height of a light point l over the plane (a, b, c), as a function of l's coordinates: det(b − a, c −
  /// a, l − a), times `sign`.
  [[nodiscard]] HalfPlane above_plane(const std::array<glm::vec3, 3>& corners, int sign) const;

 private:
  using Integers = std::array<mpz_class, 3>;

  IntegerGrid grid_;
  Integers p_, c_, u_, v_;       ///< c is a direction for a sun
  Integers to_s_, to_t_, to_w_;  ///< S, T, W are the products of these with q − p
  mpz_class reach_;              ///< K, made positive
  bool mirrored_ = false, endless_ = false;
  GridBox box_;
};

/// Returns a · |height of b| + b · |height of a|: the crossing of a plane with the edge from a to b, which are on
/// different sides of it.
ProjectivePoint crossing(const ProjectivePoint& a, const mpz_class& height_a, const ProjectivePoint& b,
                         const mpz_class& height_b);

}  // namespace penumbra::areas
