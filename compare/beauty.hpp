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

/// What a method said about one light, one entry a pixel: form factors if it integrates cosines itself, else masks
/// (words_per_mask() words a pixel) if it makes them, else V. Exactly one of the three is not empty, but that V comes
/// with form factors if there are shading normals.
struct LightVisibility {
  std::span<const std::uint32_t> masks = {};
  std::span<const float> visibility = {};
  std::span<const glm::dvec3> form_factors = {};  ///< Method::read_form_factors
  /// With masks of dimmed light: of each pair, and which pixels have any (visibility::FilteredMasks).
  std::span<const float> transmittances = {};
  std::span<const std::uint8_t> dimmed = {};
};

/// What is shaded, and from where the light comes.
struct BeautyScene {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  std::span<const glm::dvec3> colors;  ///< linear base colour of each object
  std::span<const visibility::Light> lights;
  std::span<const glm::dvec3> pixel_colors = {};  ///< of each pixel, in place of the objects' (compare/surface.hpp)
  std::span<const glm::vec3> normals = {};        ///< of each pixel, for cosines, in place of the samples' own
  std::size_t first_pixel = 0;                    ///< what is asked is about pixels from this on
};

/// The linear beauty of each pixel, for diffuse surfaces lit directly:
///
///   Σ_lights colour · radiance · F,    F = 1/π ∫ visible · max(0, cos θp) · cos θl / d² dl
///
/// d from the view sample to the light, θp between d and the view sample's normal, θl between −d and the light's, on
/// sides that emit. A texture multiplies radiance by the texel at l.
///
///   form factors:  F as the method gives it
///   masks:         F of the visible cells, or of the visible samples (compare/visible_light.hpp)
///   V:             V · F of the whole light, in closed form
///
/// The second is equation 1.3 of the rendering integral with visibility inside, the third equation 1.4, which takes
/// visibility out of the integral: where the light is half hidden the two differ by what a method that only knows V
/// cannot know. As the number of light samples grows, the second becomes the integral. Where nothing hides the light
/// all are the same to the last bit. docs/radiance.md has derivations and errors.
///
/// With shading normals (BeautyScene::normals) cosines are theirs, and light comes from what is visible all the same:
/// V and masks know only the triangle and what is above its plane, so the terminator is where either normal turns away.
/// Form factors are of the triangle's own normal: where a pixel has another, its beauty is F of the whole light times
/// the visible share of the form factor (of a textured light, or one that is partly below the triangle's plane: times
/// V).
///
/// Pixels of a light's body show its radiance (with a texture, times the texel that is there or nearest; none if that
/// light is not among `lights`: it is off) beside what its colour reflects of the other lights, the background is 0,
/// and what receives no shadow is lit as if nothing stood between. A sphere light is the disk that p sees of it, which
/// fills its solid angle.
///
/// Each pixel is summed in double and in one order, so the result does not depend on the number of threads.
std::vector<glm::vec3> integrate_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility);

/// The same of so many pixels from BeautyScene::first_pixel on, with as many entries in `visibility`, added to what
/// `beauty` has. `wanted` (empty, or of each of these pixels): those with NaN stay as they are.
void add_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility, std::span<const float> wanted,
                std::span<glm::vec3> beauty);

}  // namespace penumbra::compare
