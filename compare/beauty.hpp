// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::compare {

/// Result of a method for one light, one entry for each pixel: form factors if the method integrates cosines itself,
/// else masks (words_per_mask() words a pixel) if the method computes masks, else V. Exactly one of the three is not
/// empty, except that V comes with form factors if there are shading normals.
struct LightVisibility {
  std::span<const std::uint32_t> masks = {};
  std::span<const float> visibility = {};
  std::span<const glm::dvec3> form_factors = {};  ///< Method::read_form_factors
  /// With masks of dimmed light: transmittance of each pair, and the pixels with any dimmed pair
  /// (visibility::FilteredMasks).
  std::span<const float> transmittances = {};
  std::span<const std::uint8_t> dimmed = {};
};

/// Scene, view samples and lights to be shaded.
struct BeautyScene {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  std::span<const glm::dvec3> colors;  ///< linear base colour of each object
  std::span<const visibility::Light> lights;
  std::span<const glm::dvec3> pixel_colors = {};  ///< of each pixel, in place of the objects' colours
                                                  ///< (compare/surface.hpp)
  std::span<const glm::vec3> normals = {};        ///< of each pixel, for cosines, in place of the samples' own normals
  std::size_t first_pixel = 0;                    ///< first pixel of the entries in `visibility`
};

/// Returns the linear beauty of each pixel, for diffuse surfaces lit directly:
///
///   Σ_lights colour · radiance · F,    F = 1/π ∫ visible · max(0, cos θp) · cos θl / d² dl
///
/// d from the view sample to the light, θp between d and the view sample's normal, θl between −d and the light's, on
/// sides that emit. A texture multiplies radiance by the texel at l.
///
///   form factors:  F as returned by the method
///   masks:         F of the visible cells, or of the visible samples (compare/visible_light.hpp)
///   V:             V · F of the whole light, in closed form
///
/// The second is equation 1.3 of the rendering integral with visibility inside, the third equation 1.4, which takes
/// visibility out of the integral: where the light is half hidden, the two differ by an amount that V alone does not
/// determine. As the number of light samples grows, the second converges to the integral. Where nothing hides the light
/// all are the same to the last bit. docs/radiance.md has derivations and errors.
///
/// With shading normals (BeautyScene::normals), cosines use these, while visibility is unchanged: V and masks depend
/// only on the triangle and the space above its plane, so the terminator is where either normal turns away. Form
/// factors use the triangle's own normal: where a pixel has another normal, its beauty is F of the whole light times
/// the visible fraction of the form factor (for a textured light, or one that is partly below the triangle's plane,
/// times V).
///
/// Pixels of a light's body show its radiance (with a texture, times the texel there or nearest; none if this light is
/// not among `lights`, since it is off) plus the light of the other lights reflected by its colour; the background is
/// 0, and surfaces that receive no shadow are lit without occluders. A sphere light is the disk visible from p, which
/// fills its solid angle.
///
/// Each pixel is summed in double and in one order, so the result does not depend on the number of threads.
std::vector<glm::vec3> integrate_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility);

/// Adds to `beauty` the beauty of as many pixels as `visibility` has entries, from BeautyScene::first_pixel on.
/// `wanted` (empty, or one value for each of these pixels): pixels with NaN are left unchanged.
void add_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility, std::span<const float> wanted,
                std::span<glm::vec3> beauty);

}  // namespace penumbra::compare
