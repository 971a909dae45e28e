#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::compare {

/// What a method said about one light: masks (words_per_mask() words a pixel) if it makes them, else V (one a pixel).
/// Exactly one of the two is not empty.
struct LightVisibility {
  std::span<const std::uint32_t> masks;
  std::span<const float> visibility;
};

/// What is shaded, and from where the light comes.
struct BeautyScene {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  std::span<const glm::dvec3> colors;  ///< linear base colour of each object
  std::span<const visibility::Light> lights;
};

/// The linear beauty of each pixel, for diffuse surfaces lit directly. With light points l_j, d = l_j − p, θp between
/// d and the view sample's normal, θl between −d and the light's (its absolute cosine for a two-sided light):
///
///   masks:  colour / π · Σ_lights area / N · radiance · Σ_j visible_j · max(0, cos θp) · max(0, cos θl) / d²
///   V:      the same with every visible_j = 1, times V
///
/// The first is equation 1.3 of the rendering integral with visibility inside, the second equation 1.4, which takes
/// visibility out of the integral: where the light is half hidden the two differ by what a method that only knows V
/// cannot know. A texture multiplies radiance by the texel at each l_j, in both.
///
/// Pixels of a light's body show its radiance (with a texture, times the texel that is there or nearest; black if that
/// light is not among `lights`: it is off), the background is 0, and what receives no shadow is lit as if nothing stood
/// between. A sphere light is the disk through its centre that faces p.
///
/// Each pixel is summed in double and in one order, so the result does not depend on the number of threads.
std::vector<glm::vec3> integrate_beauty(const BeautyScene& scene, std::span<const LightVisibility> visibility);

}  // namespace penumbra::compare
