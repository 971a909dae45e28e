// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <span>

namespace penumbra::visibility {

/// Form factors of diffuse lights at a surface element with the unit normal n, in closed form:
///
///     F = 1/π ∫ max(0, cos θp) |cos θl| / d² dl        (for radiance 1: irradiance / π; the whole hemisphere: 1)
///
/// By Stokes' theorem F is an integral along the light's boundary: J. H. Lambert, Photometria (1760); here as in D.
/// Baum, H. Rushmeier, J. Winget, "Improving radiosity solutions through the use of analytically determined
/// form-factors" (SIGGRAPH 1989). With corners rᵢ as seen from the element,
///
///     F = 1/2π Σ θᵢ n · γᵢ,    θᵢ the angle between rᵢ and rᵢ₊₁, γᵢ the unit vector along rᵢ × rᵢ₊₁.
///
/// All positions are relative to the element. Signs: positive if the polygon runs clockwise as seen from the element.
///
/// Horizon. The part below the element's plane must be cut off. All cuts through a flat light lie on one line, and
/// along a line angles add up: so each edge is cut separately, and cuts downward and upward are joined in pairs in
/// order of occurrence, which is also correct for polygons that are not convex.
///
/// Errors. θ is computed by a polynomial (angle_over_sine.hpp), rᵢ × rᵢ₊₁ as ½ (rᵢ + rᵢ₊₁) × (rᵢ₊₁ − rᵢ). With ε = 2⁻⁵³
/// the product is off by about 4ε |rᵢ + rᵢ₊₁| |edge| / 2: no more than if both corners were moved by a few ulps of
/// their distance. An edge that is short for its distance (θ ≤ π/8) adds an error of a few ε |edge| / distance, so that
/// a light of size a at the distance d has a relative error of a few ε d / a, not ε d² / a²: the terms of its edges
/// cancel, but their errors are as small as the edges. (Where the horizon cuts so small a light the error is ε d² /
/// a².) An edge that nearly contains the element (θ near π) is ill-conditioned: F itself changes by up to 1/2 when the
/// element crosses it.
///
/// An edge run backward gives exactly the negative: pieces with common edges add up to their union up to the rounding
/// of the sum.

/// Returns the term of one edge, with its direction b − a given (it may have more precision than the difference). 0 for
/// an edge of no length, and for one that contains the element.
struct FormFactorEdge {
  glm::dvec3 a{0}, b{0}, direction{0};
};
double form_factor_term(const FormFactorEdge& edge, const glm::dvec3& n);

/// Adds up the edges of a flat polygon in order, each beginning at the end of the previous one; cuts them at the
/// horizon. Complete once the polygon is closed.
class FormFactorLoop {
 public:
  explicit FormFactorLoop(const glm::dvec3& n) : n_(n) {}
  /// Adds an edge with the heights n · a and n · b over the element's plane.
  void add(const FormFactorEdge& edge, double height_a, double height_b);
  [[nodiscard]] double sum() const { return sum_; }

 private:
  void close(const glm::dvec3& down, const glm::dvec3& up);

  glm::dvec3 n_;
  double sum_ = 0;
  std::optional<glm::dvec3> down_, up_;  // a cut that waits for its partner; never both
};

/// A curved edge: part of an ellipse's rim, center + cos φ u + sin φ v, from the angle `from` to `from` + `arc`
/// (radians). All of it must be above the element's plane.
///
/// By quadrature: n · (r × r′) / |r|² is analytic in complex φ except where r · r = 0, which is farther from the real
/// axis than δ = ln(1 + (√2 − 1) |r| / (|u| + |v|)): |r(φ + ε) − r(φ)| ≤ (|u| + |v|) (e^|ε| − 1), and r · r = 0 needs a
/// change of (√2 − 1) |r|. Ten points (Gauss, Legendre) on a piece of half-length h ≤ δ / 3.3 leave an error of (3.3 +
/// √(3.3² − 1))⁻²⁰ = 5e-17 of the integrand's size there; pieces are halved until that holds.
struct FormFactorArc {
  glm::dvec3 center{0}, u{0}, v{0};  ///< relative to the element
  double from = 0, arc = 0;
};
double form_factor_arc(const FormFactorArc& arc, const glm::dvec3& n);

/// Returns the form factor of a closed planar polygon, convex or not.
double form_factor(std::span<const glm::dvec3> corners, const glm::dvec3& n);

/// A disk whose plane does not contain the element, for either of its sides: form_factor() is never negative. In closed
/// form, with or without a horizon: with h its height, ρ the element's distance from its axis, A = R² + ρ² + h² and B =
/// 2ρR, the integrands along the rim are 1, cos φ and sin φ, each divided by A − B cos φ.
struct FormFactorDisk {
  glm::dvec3 center{0};  ///< relative to the element
  glm::dvec3 normal{0};  ///< unit
  double radius = 0;
};
double form_factor(const FormFactorDisk& disk, const glm::dvec3& n);

/// An ellipse, center + s u + t v with s² + t² ≤ 1, whose plane does not contain the element: form_factor() is never
/// negative. The form factor depends only on the cone of directions to the rim, and every cone over an ellipse is also
/// a cone over a circle: that circle's disk is integrated. Errors in addition to the disk's: a few ε of the cone's
/// axes.
struct FormFactorEllipse {
  glm::dvec3 center{0};  ///< relative to the element
  glm::dvec3 u{0}, v{0};
};
double form_factor(const FormFactorEllipse& ellipse, const glm::dvec3& n);

}  // namespace penumbra::visibility
