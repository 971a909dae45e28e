// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/dome_picture.hpp"
#include "visibility/light_samples.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <memory>
#include <mutex>
#include <tuple>

namespace penumbra::visibility {

struct SkyTables;

/// Vector of ∫ radiance ω dω over directions ω, one column for each colour, in the sky's own axes.
using SkyFlux = glm::dmat3;

/// The picture of a dome, constant in each texel, integrated over regions of directions whose borders are great
/// circles: straight lines on the dome's faces. docs/domes.md, "Exact, of a picture".
///
/// Errors. Every integral is in closed form; what remains is rounding: a few 2⁻⁵³ of the picture's whole light for each
/// texel that a border crosses. Thread-safe.
class Sky {
 public:
  /// Copies the picture; tables are made on first use, since light samples do not need them. `frame`: axes of the
  /// picture. `dome`: axes and extent of the faces.
  Sky(const scenes::Texture& picture, const DomeFrame& frame, const Light::Dome& dome);
  ~Sky();
  Sky(const Sky&) = delete;
  Sky& operator=(const Sky&) = delete;

  /// Makes the tables. Throws ResourceError if memory does not suffice.
  void prepare() const { std::ignore = tables(); }
  /// Returns the part of the flux that a straight side of a region contributes, by Stokes' theorem: the contributions
  /// of the sides of a polygon, counter-clockwise in (s, t) of dome_face, add up to the flux from the polygon. A side
  /// on the border of a face, or at t = 0, takes few steps; any other side takes one for each texel that it crosses. ∫
  /// luminance dτ along the side, τ the angle along it, is added to `exposure`, except for sides on those borders,
  /// which are exact. A side that is off by ε changes the flux by ε times its exposure.
  [[nodiscard]] SkyFlux side(std::size_t face, const glm::dvec2& from, const glm::dvec2& to, double& exposure) const;
  /// Returns the flux from the emitting part of a face (dome_face_corners).
  [[nodiscard]] const SkyFlux& of_face(std::size_t face) const;
  /// Returns the flux from the emitting part of a face above the plane orthogonal to n, a vector in world space.
  [[nodiscard]] SkyFlux of_face_above(std::size_t face, const glm::dvec3& n) const;
  /// Returns the flux from all directions above the plane orthogonal to n.
  [[nodiscard]] SkyFlux above(const glm::dvec3& n) const;
  /// Returns the form factor of a flux at an element of unit normal n, for each colour: 1/π n · flux.
  [[nodiscard]] glm::dvec3 form_factor(const SkyFlux& flux, const glm::dvec3& n) const;
  /// Returns a bound of the rounding of form factors' luminances.
  [[nodiscard]] double rounding() const;
  /// Returns the mean luminance of all directions of the dome.
  [[nodiscard]] double mean_luminance() const;

 private:
  [[nodiscard]] SkyTables& tables() const;

  DomeFrame frame_;
  Light::Dome dome_;
  mutable std::once_flag once_;
  mutable scenes::Texture picture_;  // used until the tables are made
  mutable std::unique_ptr<SkyTables> tables_;
};

}  // namespace penumbra::visibility
