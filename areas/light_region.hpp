// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// Light as an exact region of its own plane. Internal to areas/.

namespace penumbra::areas {

/// Point of the light's plane, centre + s · u + t · v with u, v the axes of the stored frame.
struct PlanePoint {
  mpq_class s, t;
};

/// Polygon in frame coordinates, counter-clockwise; closed. Not necessarily convex (rounding may dent a stored
/// outline).
using Region = std::vector<PlanePoint>;

/// Returns the light in its frame's coordinates, exact for the stored values. rectangle: [−1, 1]², the parallelogram
/// spanned by centre ± u ± v (its corners are within rounding of the stored outline). polygon: the stored outline,
/// projected at right angles onto the frame's plane. A dome's face: [−1, 1]², or its upper half. Round lights
/// (is_round): the square around the unit disk.
Region light_region(const visibility::Light& light);

mpq_class area_of(const Region& region);

/// Half-plane at + s · along_s + t · along_t ≥ 0; clip() returns the part of the region in it.
struct HalfPlane {
  mpz_class at, along_s, along_t;
};
Region clip(const Region& region, const HalfPlane& half_plane);

/// Rectangle around a region with sides at multiples of 1 / kGrid: small numbers, for fast arithmetic.
struct GridBox {
  static constexpr long kGrid = 1024;
  mpz_class s0, s1, t0, t1;  ///< times kGrid
};
GridBox box_around(const Region& region);

/// The power of two, 2^bits, that turns all doubles of a set into integers when multiplied with them.
class IntegerGrid {
 public:
  void include(double value);
  void include(const glm::vec3& point);
  void include(const IntegerGrid& other);
  [[nodiscard]] mpz_class integer(double value) const;
  [[nodiscard]] std::array<mpz_class, 3> integers(const glm::dvec3& point) const;

 private:
  int bits_ = 0;
};

}  // namespace penumbra::areas
