// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_box.hpp"
#include "engines/pairs/light_pixels.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::pairs {

/// The far plane of a light's frustum, parallel to the light through the farthest view sample: view samples are
/// projected onto it from the light's centre and stored in lists of light pixels, and a triangle's footprint there is
/// the hull of the projections of its corners from the light's corners (Sintorn, Eisemann and Assarsson 2008, sections
/// 4.1 and 4.2).
///
/// The footprint contains the place q of each view sample p, also of those above the plane, from which a point x of the
/// triangle hides a light point l: with k = f / x_h and s = p_h / x_h, 1 ≤ s ≤ k, p = l + s (x − l), so
/// q = p f / p_h = k x + k (1/s − 1) l = k x + (1 − k) l',  l' = l (k − k/s) / (k − 1),
/// and l' is between the centre, 0, and l. For each l', q is the end of the segment from l' through x. For one l' the
/// ends of all x of a triangle form a triangle; for all l' and x their hull is that of the corners' projections. For a
/// sun the same holds with light points at infinity: q = x − (f − x_h) σ', σ' between 0 and σ.
class FarPlane {
 public:
  /// Largest slope of the frustum: |a| or |b| of a view sample over its distance h.
  static constexpr double kWidest = 8;

  FarPlane() = default;
  /// `side`: −1 for view samples behind a two-sided light. `reach`: at least the length of all positions. View samples
  /// on the other side are left out; those in the light's plane up to rounding, or outside of the frustum, are in
  /// `outside`.
  FarPlane(const LightBox& light, double side, double reach, std::span<const std::uint32_t> pixels,
           std::span<const glm::vec3> p, double per_pixel);

  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] const std::vector<std::uint32_t>& outside() const { return outside_; }
  /// Returns the pixel of an index in the lists.
  [[nodiscard]] std::uint32_t pixel(std::uint32_t number) const { return pixels_[number]; }
  [[nodiscard]] std::span<const double> heights() const& { return heights_; }
  std::span<const double> heights() const&& = delete;
  [[nodiscard]] LightPixels& light_pixels() { return light_pixels_; }

  /// Returns the triangle's footprint. If it has no points and is not `everywhere`, the triangle hides nothing from any
  /// view sample.
  [[nodiscard]] Footprint footprint(const std::array<glm::vec3, 3>& corners) const;
  /// Returns a lower bound of the triangle's distance from the light: less than the height of every view sample from
  /// which it hides anything.
  [[nodiscard]] double nearest(const std::array<glm::vec3, 3>& corners) const;

 private:
  /// Returns (a, b, h), h growing with the distance from the light on this side.
  [[nodiscard]] glm::dvec3 place(const glm::vec3& x) const {
    glm::dvec3 at = light_.place(glm::dvec3(x));
    at.z *= side_;
    return at;
  }
  void add_upper(Footprint& footprint, std::span<const glm::dvec3> polygon) const;
  [[nodiscard]] bool misses_window(std::span<const glm::dvec3> polygon) const;

  LightBox light_;
  double side_ = 1, error_ = 0;  ///< error_: error of a place
  double far_ = 0;
  std::vector<std::uint32_t> pixels_, outside_;
  std::vector<double> heights_;
  LightPixels light_pixels_;
};

}  // namespace penumbra::pairs
