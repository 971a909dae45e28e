#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>

namespace penumbra::visibility {

/// A light as a surface element (p, n) sees it that nothing shadows: form factors (form_factor.hpp) of the light and of
/// parts of it. All are 0 if p is not strictly on an emitting side (pair_truth.hpp, exact), and what is below the
/// element's plane is cut off. `n` is normalised here: stored normals are float32.
///
/// Errors beside form_factor.hpp's: a point of the light is c + s u + t v in double, relative to p, off by a few 2⁻⁵³
/// of its distance. A disk is a circle with its stored radius: its stored axes are off that by float32's 6e-8.
class UnshadowedLight {
 public:
  /// `light` must outlive it.
  UnshadowedLight(const Light& light, const glm::vec3& p, const glm::vec3& n);

  /// Does p lie strictly on an emitting side?
  [[nodiscard]] bool shines() const { return side_ != 0; }
  /// Is every corner that bounds the light (Light::outline; a sphere: its disk) above the element's plane?
  [[nodiscard]] bool above_horizon() const;
  /// Of all the light: rectangle c ± u ± v, polygon by its outline in the frame's plane, disk and what p sees of a
  /// sphere as a circle, ellipse as its frame's, sun as a disk at distance 1. Of a sun of one direction, of irradiance:
  /// n · d.
  [[nodiscard]] double whole() const;
  /// Of a polygon in the frame's coordinates (s, t), counter-clockwise; of a disk's or a sphere's frame what of it is
  /// in the unit disk: the polygon is convex then and has up to 10 corners.
  [[nodiscard]] double part(std::span<const glm::dvec2> corners) const;
  /// Of the part from `low` to `high`.
  [[nodiscard]] double box(const glm::dvec2& low, const glm::dvec2& high) const;
  [[nodiscard]] const Light& light() const { return light_; }
  [[nodiscard]] const glm::dvec3& p() const { return p_; }
  [[nodiscard]] const glm::dvec3& normal() const { return n_; }
  /// Unit, perpendicular to the light, away from the side that p is on.
  [[nodiscard]] const glm::dvec3& along() const { return along_; }
  /// Of a light that is a circle, at the distance of frame().center.
  [[nodiscard]] double radius() const { return radius_; }
  /// What part() computes with, for whoever does many side by side.
  struct Frame {
    glm::dvec3 center{0}, u{0}, v{0};               ///< relative to p
    double height = 0, height_u = 0, height_v = 0;  ///< n · these
    int side = 0;                                   ///< +1: p is where u × v points, −1: behind, 0: dark
  };
  [[nodiscard]] Frame frame() const { return {center_, u_, v_, height_, height_u_, height_v_, side_}; }

 private:
  [[nodiscard]] double part_of_disk(std::span<const glm::dvec2> corners) const;

  const Light& light_;
  glm::dvec3 p_, n_;
  glm::dvec3 along_{0};                 ///< unit, perpendicular to the light, away from the side that p is on
  glm::dvec3 center_{0}, u_{0}, v_{0};  ///< the frame, relative to p
  double radius_ = 0;                   ///< disk, and a sphere's
  double height_ = 0, height_u_ = 0, height_v_ = 0;  ///< n · these
  int side_ = 0;  ///< +1: p is where u × v points, −1: behind (and the light has two sides), 0: dark
};

}  // namespace penumbra::visibility
