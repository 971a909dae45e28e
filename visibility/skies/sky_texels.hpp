// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/skies/sky.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

/// Texels of a dome's picture, and integrals along great circles over them. Inside visibility/skies/ only.
namespace penumbra::visibility {

/// A direction on a great circle, given by the values that the integral along the circle needs.
struct SkyPoint {
  double cosine = 1, sine = 0;  ///< of the azimuth
  double latitude = 0;
  double across = 0;  ///< azimuth from the left border of the texel's column
  double turn = 0;    ///< angle along the circle
};

/// Index of a texel: columns run with the azimuth, rows downward from the pole.
struct SkyCell {
  std::size_t column = 0, row = 0;
};

/// A great circle from a to b, less than half of it, in the sky's axes.
struct SkyArc {
  glm::dvec3 a{1, 0, 0}, b{0, 1, 0}, axis{0}, along{0};  ///< unit vectors; axis is along a × b, along = axis × a
  /// True if the arc contributes nothing: it has no length, or lies on a meridian.
  bool is_empty = true;

  SkyArc(const glm::dvec3& from, const glm::dvec3& to);
  /// Returns the angle from a to a direction on the circle, in (−π, π].
  [[nodiscard]] double turn_of(const glm::dvec3& direction) const;
};

/// The pole from which integrals along meridians begin: a region may contain this pole, but not the other one.
enum class SkyPole { north, south };

/// Texels of a picture in the sky's axes: the pole is +z; the azimuth, from +x to +y, is 0 at the picture's right end,
/// and runs to its left.
///
/// With Ψ(φ, z) = ∫ radiance ω dz from z to the pole's 1, Green's theorem makes the flux from a region ∫ Ψ dφ along its
/// border, counter-clockwise as seen from outside of the sphere. In a texel Ψ is a sum over the texels between it and
/// the pole, kept as prefix sums, and a closed form of the texel's own part. With r × dr = axis dτ, λ the latitude and
/// A = (z √(1 − z²) + λ) / 2, the integral over the part of a great circle in a texel of radiance c and upper border z₀
/// is
///
///     (k₁ [sin φ] − c/2 [λ sin φ],  −k₁ [cos φ] + c/2 [λ cos φ],  k₂ [φ]) + c/2 axis [τ],
///
/// k₁ the prefix sum of c [A] plus c A(z₀), k₂ that of c [z²] / 2 less c (1 − z₀²) / 2.
class SkyTexels {
 public:
  /// `half`: the half below z = 0 is black.
  SkyTexels(const scenes::Texture& picture, bool half);

  /// Adds the integral along an arc to `flux`. Returns ∫ luminance dτ along the arc.
  double integrate(const SkyArc& arc, SkyPole pole, SkyFlux& flux) const;
  /// Returns the flux from all directions above z = −1 with azimuths from 0 to `azimuth` in [0, 2π].
  [[nodiscard]] SkyFlux wedge(double azimuth) const;
  /// Returns the mean luminance of all directions, of half a dome of its half.
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }

  /// Calls visit(cell, from, to) for the parts of an arc in each texel, in order.
  template <typename Visit>
  void walk(const SkyArc& arc, const Visit& visit) const;
  /// Adds the integral along a part of a great circle within one texel. Returns that of the luminance.
  double add_part(const SkyCell& cell, SkyPole pole, const SkyPoint& from, const SkyPoint& to, const glm::dvec3& axis,
                  SkyFlux& flux) const;
  /// Returns a direction as a point of an arc, in relation to a column.
  [[nodiscard]] SkyPoint point_of(const SkyArc& arc, const glm::dvec3& direction, std::size_t column) const;

 private:
  struct Sums {
    glm::dvec3 level{0}, upward{0};  // prefix sums of radiance [A], and of radiance [z²] / 2
  };
  struct Texel {
    glm::dvec3 radiance{0}, k1{0}, k2{0};
  };
  /// Border between two rows.
  struct Border {
    double slope = 0;  // tan of the latitude
    double latitude = 0, z = 0, flat = 0, a = 0;
  };
  struct Place {
    SkyCell cell;
    SkyPoint point;
    double slope = 0;
  };

  [[nodiscard]] glm::dvec3 radiance(std::size_t column, std::size_t row) const {
    return glm::dvec3(colors_[column * rows_ + row]);
  }
  void add_row(Sums& sums, std::size_t column, std::size_t row) const;
  [[nodiscard]] Texel texel(const SkyCell& cell, SkyPole pole) const;
  [[nodiscard]] double across_of(std::size_t column, double cosine, double sine) const;
  [[nodiscard]] Place place_of(const SkyArc& arc, const glm::dvec3& direction) const;
  template <typename Visit>
  void walk_monotone(const SkyArc& arc, Place& at, Place end, const Visit& visit) const;

  static constexpr std::size_t kStep = 4;  // prefix sums are kept at every fourth row, which saves memory

  std::size_t columns_, rows_;
  std::vector<glm::vec3> colors_;      // column after column
  std::vector<Border> borders_;        // rows_ + 1
  std::vector<glm::dvec2> meridians_;  // columns_ + 1: cosine and sine of their left borders
  std::vector<Sums> sums_;             // column after column
  std::vector<Sums> columns_whole_;    // of each column
  std::vector<SkyFlux> up_to_;         // flux from the columns before each
  std::size_t blocks_ = 0;             // of kStep rows in a column
  double width_;                       // of a column
  double mean_ = 0;
};

}  // namespace penumbra::visibility
