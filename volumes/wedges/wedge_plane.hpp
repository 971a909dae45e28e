// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <span>

/// Planes that bound the penumbra of an edge, and the exact signs that prove the bound.
///
/// The *penumbra* of an edge e under a light L is the set of all p from which some open segment p→l, l on L, meets e: p
/// = x + t (x − l) with x on e, t > 0. A half-space h ≥ 0 contains the penumbra exactly if h(x) ≥ 0 and h(x) ≥ h(l) for
/// all x and l, since h(p) = h(x) + t (h(x) − h(l)). Both conditions are affine, so it suffices that they hold at the
/// ends of e and the corners of L. Conservativeness is therefore a finite number of signs, which are evaluated without
/// rounding.
namespace penumbra::volumes {

/// Half-space a x + b y + c z + d ≥ 0; (a, b, c) points inward. The stored coefficients are exact.
struct Plane {
  double a = 0, b = 0, c = 0, d = 0;

  [[nodiscard]] glm::dvec3 normal() const { return {a, b, c}; }
  friend bool operator==(const Plane&, const Plane&) = default;
};

struct Box {
  glm::dvec3 lower{0}, upper{0};
};

/// Edge (or a piece of an edge) that casts a penumbra, and the corners of a light's hull.
struct EdgeAndLight {
  glm::dvec3 a{0}, b{0};
  std::span<const glm::dvec3> light;
};

/// Returns the sign of h(p). Exact for finite coordinates.
int side_of(const Plane& plane, const glm::dvec3& p);

/// Returns the sign of n · (x − l). Exact.
int sign_along(const glm::dvec3& n, const glm::dvec3& x, const glm::dvec3& l);

/// Returns whether the whole penumbra is certainly in the half-space (zero included). Exact.
bool bounds_penumbra(const Plane& plane, const EdgeAndLight& cast);

/// Returns the half-space with approximately this inward normal that touches `cast`'s edge or, if given, the point
/// `through`, rounded outward until bounds_penumbra holds: the normal is turned towards `inward`, a direction with
/// inward · (x − l) > 0, by a few units in the last place, and d is rounded up. Returns nullopt if the rounding would
/// change the normal by more than 2⁻²⁰ of its size.
std::optional<Plane> bounding_plane(glm::dvec3 normal, const EdgeAndLight& cast, const glm::dvec3& inward,
                                    const std::optional<glm::dvec3>& through = {});

/// Returns a direction m with m · (x − l) > 0 (exactly) for the ends x of the edge and all corners l: m separates edge
/// and light. Returns nullopt if there is no such direction: edge and light touch, or are closer than doubles can
/// resolve.
std::optional<glm::dvec3> separating_direction(const EdgeAndLight& cast);

}  // namespace penumbra::volumes
