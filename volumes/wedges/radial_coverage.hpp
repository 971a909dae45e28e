#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

/// What one edge, as seen from a view sample p, cuts off a planar light L as seen from a point C of it (Assarsson and
/// Akenine-Möller 2003; derived in docs/coverage.md). All in *frame coordinates* (s, t): centre + s u + t v, with u, v
/// the light's stored frame; the rectangle is [−1, 1]², the disk the unit disk. A sphere is, at each p, the disk
/// that p sees, in visibility::light_frame_from (what its light samples and `exact` are of). Double throughout.
namespace penumbra::volumes {

/// The light as a convex region of its own plane.
struct LightOutline {
  std::vector<glm::dvec2> corners;  ///< counter-clockwise; none: the unit disk
  double area = 0;                  ///< in frame coordinates
};
/// A sphere's is the unit disk: the disk that p sees.
LightOutline light_outline(const visibility::Light& light);

/// Of the outline's area, the part where at + s · along.x + t · along.y ≥ 0, in [0, 1].
double share_above(const LightOutline& outline, double at, const glm::dvec2& along);

/// A point x on its way from p through x to the light's plane, homogeneous: s = X/W, t = Y/W. W is 0 on the plane
/// through p parallel to the light, and 1 on the light. Affine in x.
struct Projected {
  double x = 0, y = 0, w = 0;
  double error_x = 0, error_y = 0, error_w = 0;  ///< bounds of what rounding did to them, up to a common factor

  [[nodiscard]] glm::dvec2 point() const { return {x / w, y / w}; }
  /// A bound of |s − computed| + |t − computed|.
  [[nodiscard]] double error() const;
};

/// The back-projection of one view sample, which must be off the light's plane, or outside a sphere (asserted).
class LightProjection {
 public:
  LightProjection(const visibility::Light& light, const glm::vec3& p);

  [[nodiscard]] Projected operator()(const glm::dvec3& x) const;
  /// Certainly no point of the edge appears in the interior of this box around a light. A third of the work.
  [[nodiscard]] bool misses(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& lower,
                            const glm::dvec2& upper) const;
  /// +1: what is counter-clockwise as seen from p is so in (s, t); −1: p is behind the light. Exact.
  [[nodiscard]] int turn() const { return turn_; }

 private:
  glm::dvec3 p_, row_x_, row_y_, row_w_, size_x_, size_y_, size_w_;
  int turn_ = 0;
};

/// The part of an edge that lies between p and the light's plane and appears within L.
struct ClippedEdge {
  glm::dvec2 from{0}, to{0};
  double from_error = 0, to_error = 0;
};
/// Nothing if that is a point or less. An end that is inside is the vertex's own point: edges that share a vertex share
/// the numbers.
std::optional<ClippedEdge> clip_to_light(const LightOutline& outline, const Projected& a, const Projected& b);

/// How the angle of a disk's sector is found.
enum class Arc : std::uint8_t {
  tangent,  ///< as the difference of two
  cosine,   ///< of the angle between its sides, where C is the disk's centre (Johnson et al. 2009); off by up to 2e-8
};

/// Areas as seen from C, strictly inside L.
class RadialCoverage {
 public:
  RadialCoverage(const LightOutline& outline, const glm::dvec2& reference, Arc arc = Arc::tangent);

  /// ∫_L [the segment C→l crosses the edge] dl, times the sign of the turn from→to around C: the sector of L over the
  /// edge less the triangle (C, from, to). `side` is that sign as decided exactly: where the sector is near half a
  /// turn, rounding must not. The error is a few units in the last place of |L|, plus what the ends' errors make: see
  /// docs/coverage.md.
  [[nodiscard]] double beyond(const ClippedEdge& edge, int side) const;

  /// Can `beyond` trust the direction of an end? Not if it lies within four times its error of C.
  [[nodiscard]] bool is_clear_of(const glm::dvec2& end, double error) const;

 private:
  [[nodiscard]] double fan_area(const glm::dvec2& direction) const;

  const LightOutline* outline_;
  glm::dvec2 reference_;
  bool by_cosine_;
  std::vector<double> up_to_;  // of the fan triangles (C, corner i, corner i + 1): the area before i
};

}  // namespace penumbra::volumes
