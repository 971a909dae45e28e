// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>

namespace penumbra::visibility {

/// A light as seen from a surface element (p, n), without occluders: form factors (form_factor.hpp) of the light and of
/// parts of it. All are 0 if p is not strictly on an emitting side (pair_truth.hpp, exact), and the part below the
/// element's plane is cut off. `n` is normalised here: stored normals are float32.
///
/// Errors in addition to form_factor.hpp's: a point of the light is c + s u + t v in double, relative to p, off by a
/// few 2⁻⁵³ of its distance. A disk is a circle with its stored radius: its stored axes differ from that by float32's
/// 6e-8.
class UnshadowedLight {
 public:
  /// `light` must outlive this object.
  UnshadowedLight(const Light& light, const glm::vec3& p, const glm::vec3& n);

  /// Returns whether p lies strictly on an emitting side.
  [[nodiscard]] bool shines() const { return side_ != 0; }
  /// Returns whether every corner that bounds the light (Light::outline; a sphere: its disk) is above the element's
  /// plane.
  [[nodiscard]] bool above_horizon() const;
  /// Returns the form factor of the whole light: rectangle c ± u ± v, polygon by its outline in the frame's plane, disk
  /// and visible disk of a sphere as a circle, ellipse as the frame's ellipse, sun as a disk at distance 1. For a sun
  /// of one direction d, whose radiance stands for irradiance / π: n · d.
  [[nodiscard]] double whole() const;
  /// Returns the form factor of a polygon in the frame's coordinates (s, t), counter-clockwise; for the frame of a disk
  /// or a sun that of the polygon's part in the unit disk: the polygon must then be convex with up to 10 corners.
  [[nodiscard]] double part(std::span<const glm::dvec2> corners) const;
  /// Returns the form factor of the box from `low` to `high`.
  [[nodiscard]] double box(const glm::dvec2& low, const glm::dvec2& high) const;
  [[nodiscard]] const Light& light() const { return light_; }
  [[nodiscard]] const glm::dvec3& p() const { return p_; }
  [[nodiscard]] const glm::dvec3& normal() const { return n_; }
  /// Returns the unit normal of the light, pointing away from the side that p is on.
  [[nodiscard]] const glm::dvec3& along() const { return along_; }
  /// Returns the radius of a light that is a circle, at the distance of frame().center.
  [[nodiscard]] double radius() const { return radius_; }
  /// Values that part() uses, for code that computes many parts in vectors.
  struct Frame {
    glm::dvec3 center{0}, u{0}, v{0};               ///< relative to p
    double height = 0, height_u = 0, height_v = 0;  ///< dot products of n with these
    int side = 0;  ///< +1: p is on the side that u × v points to, −1: behind, 0: dark
  };
  [[nodiscard]] Frame frame() const { return {center_, u_, v_, height_, height_u_, height_v_, side_}; }

 private:
  [[nodiscard]] double part_of_disk(std::span<const glm::dvec2> corners) const;

  const Light& light_;
  glm::dvec3 p_, n_;
  glm::dvec3 along_{0};                              ///< unit normal of the light, away from the side that p is on
  glm::dvec3 center_{0}, u_{0}, v_{0};               ///< the frame, relative to p
  double radius_ = 0;                                ///< for a disk or sphere
  double height_ = 0, height_u_ = 0, height_v_ = 0;  ///< dot products of n with the frame
  int side_ = 0;  ///< +1: p is on the side that u × v points to, −1: behind (and the light has two sides), 0: dark
};

}  // namespace penumbra::visibility
