// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/lights/unshadowed_light.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::compare {

/// View sample and its view of the light without occluders.
struct LitPoint {
  const visibility::UnshadowedLight& seen;
  glm::vec3 p{0};
};

/// Computes form factors (visibility/lights/form_factor.hpp) of the visible part of one light from its masks, with a
/// texture separately for each colour: Σ over texels of texel · form factor.
///
/// All of the light: its form factor in closed form, so that methods agree wherever there is no occluder.
///
/// Cells. A rectangle with light samples in rows (patterns rows and grid) is divided into cells: row r of L is the band
/// of t between 2r/L − 1 and 2(r + 1)/L − 1, and in it each sample's cell has the points nearer to this sample than to
/// the row's other samples. Borders are half way between samples; the first cell begins and the last ends at the
/// light's border, so the light is covered once: if a row is shifted by the width of σ cells, the first is 1 + σ wide,
/// the last 1 − σ. A run of visible samples is one rectangle. At view samples whose horizon cuts the light, the sum
/// over the visible cells is scaled so that all cells whose samples are above the horizon give the form factor of the
/// whole light.
///
/// Samples. Every other light (disk, polygon, sphere, texture, patterns sobol and jittered) is summed sample by sample,
/// and the sum scaled so that all samples together give the form factor of the whole light:
///
///   whole · Σ_j visible_j texel_j w_j / Σ_j w_j,    w_j = max(0, cos θp) cos θl / d² of sample j
///
/// A dome of uniform radiance uses the same formula, with w_j the cosine at p; a dome with a picture is the sum of its
/// light samples, which have equal fractions of its light: 1/π ∫ luminance dω / N · Σ_j visible_j (texel / luminance)_j
/// cos θp.
///
/// cos θl = h / d with the same h for all samples of a plane, so that h cancels.
class VisibleLight {
 public:
  /// `light` must outlive this object.
  explicit VisibleLight(const visibility::Light& light);

  [[nodiscard]] const visibility::Light& light() const { return *light_; }
  /// Returns the form factor of the whole light; for a texture or picture, that of all light samples.
  [[nodiscard]] glm::dvec3 unshadowed(const LitPoint& at) const;
  /// Returns the same, but for a dome with a picture the form factor that is known without light samples.
  [[nodiscard]] glm::dvec3 whole(const LitPoint& at) const;
  /// Returns the form factor of the visible part. `mask`: words_per_mask() words; bits beyond the last sample are
  /// ignored. `transmittances`: factor of each light sample (applied as `texel` above; cells with a common factor keep
  /// their closed form); empty: 1.
  [[nodiscard]] glm::dvec3 visible(const LitPoint& at, std::span<const std::uint32_t> mask,
                                   std::span<const float> transmittances = {}) const;
  /// Return whether every light sample is visible, and whether any is.
  [[nodiscard]] bool sees_all(std::span<const std::uint32_t> mask) const;
  [[nodiscard]] bool sees_any(std::span<const std::uint32_t> mask) const;

 private:
  /// Light points, one coordinate after another, padded to whole blocks of 32.
  struct Points {
    std::vector<double> x, y, z;
    explicit Points(std::span<const glm::vec3> points);
  };

  [[nodiscard]] double of_cells(const visibility::UnshadowedLight& seen, std::span<const std::uint32_t> mask) const;
  [[nodiscard]] double cell_border(std::uint32_t row, std::uint32_t column) const;
  [[nodiscard]] glm::dvec3 of_runs(const LitPoint& at, double whole, std::span<const std::uint32_t> mask) const;
  [[nodiscard]] glm::dvec3 of_samples(const LitPoint& at, double whole, std::span<const std::uint32_t> mask,
                                      std::span<const float> transmittances = {}) const;

  [[nodiscard]] glm::dvec3 of_dome(const LitPoint& at, std::span<const std::uint32_t> mask,
                                   std::span<const float> transmittances = {}) const;

  const visibility::Light* light_;
  Points points_;                   ///< unused for a sphere
  std::vector<std::uint32_t> all_;  ///< mask of all samples
};

}  // namespace penumbra::compare
