// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

/// Area that one edge, as seen from a view sample p, cuts off a planar light L as seen from a point C of L (Assarsson
/// and Akenine-Möller 2003; derived in docs/coverage.md). All in *frame coordinates* (s, t): centre + s u + t v, with
/// u, v the light's stored frame; the rectangle is [−1, 1]², the disk the unit disk. A sphere is, at each p, the disk
/// visible from p, in visibility::light_frame_from (the domain of the sphere's light samples and of `exact`). Double
/// throughout.
namespace penumbra::volumes {

/// Outline of the light as a convex region of its own plane.
struct LightOutline {
  std::vector<glm::dvec2> corners;  ///< counter-clockwise; empty: the unit disk
  double area = 0;                  ///< in frame coordinates
};
/// Returns the outline of `light` in frame coordinates. A sphere's is the unit disk: the disk visible from p.
LightOutline light_outline(const visibility::Light& light);

/// Returns the fraction, in [0, 1], of the outline's area where at + s · along.x + t · along.y ≥ 0.
double share_above(const LightOutline& outline, double at, const glm::dvec2& along);

/// Projection of a point x along the ray from p through x to the light's plane, homogeneous: s = X/W, t = Y/W. W is 0
/// on the plane through p parallel to the light, and 1 on the light. Affine in x.
struct Projected {
  double x = 0, y = 0, w = 0;
  double error_x = 0, error_y = 0, error_w = 0;  ///< bounds of the rounding errors of x, y and w, up to a common factor

  [[nodiscard]] glm::dvec2 point() const { return {x / w, y / w}; }
  /// Returns a bound of |s − computed| + |t − computed|.
  [[nodiscard]] double error() const;
};

/// Back-projection of one view sample, which must be off the light's plane, or outside a sphere (asserted).
class LightProjection {
 public:
  LightProjection(const visibility::Light& light, const glm::vec3& p);

  [[nodiscard]] Projected operator()(const glm::dvec3& x) const;
  /// Returns true if certainly no point of the edge appears in the interior of the box [lower, upper] around a light.
  /// Takes a third of the work of a projection.
  [[nodiscard]] bool misses(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& lower,
                            const glm::dvec2& upper) const;
  /// Returns +1 if a turn that p sees counter-clockwise is counter-clockwise in (s, t); −1 if p is behind the light.
  /// Exact.
  [[nodiscard]] int turn() const { return turn_; }

 private:
  glm::dvec3 p_, row_x_, row_y_, row_w_, size_x_, size_y_, size_w_;
  int turn_ = 0;
};

/// Part of an edge that lies between p and the light's plane and appears within L.
struct ClippedEdge {
  glm::dvec2 from{0}, to{0};
  double from_error = 0, to_error = 0;
};
/// Returns nullopt if the clipped edge is a point or empty. An end inside the light is the vertex's own projection, so
/// edges that share a vertex have the same numbers there.
std::optional<ClippedEdge> clip_to_light(const LightOutline& outline, const Projected& a, const Projected& b);

/// Method of computing the angle of a disk's sector.
enum class Arc : std::uint8_t {
  tangent,  ///< difference of two arc tangents
  cosine,   ///< arc cosine of the angle between the sector's sides, where C is the disk's centre (Johnson et al. 2009);
            ///< off by up to 2e-8
};

/// Areas as seen from C, strictly inside L.
class RadialCoverage {
 public:
  RadialCoverage(const LightOutline& outline, const glm::dvec2& reference, Arc arc = Arc::tangent);

  /// Returns ∫_L [the segment C→l crosses the edge] dl, times the sign of the turn from→to around C: the sector of L
  /// over the edge minus the triangle (C, from, to). `side` is the exact sign of the turn, since rounding must not
  /// decide where the sector is near half a turn. The error is a few units in the last place of |L|, plus the effect of
  /// the ends' errors: see docs/coverage.md.
  [[nodiscard]] double beyond(const ClippedEdge& edge, int side) const;

  /// Returns whether `beyond` can trust the direction of an end: false if `end` lies within four times `error` of C.
  [[nodiscard]] bool is_clear_of(const glm::dvec2& end, double error) const;

 private:
  [[nodiscard]] double fan_area(const glm::dvec2& direction) const;

  const LightOutline* outline_;
  glm::dvec2 reference_;
  bool by_cosine_;
  std::vector<double> up_to_;  // for each i: area of the fan's triangles (C, corner j, corner j + 1) with j < i
};

}  // namespace penumbra::volumes
