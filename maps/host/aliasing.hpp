// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/face_fit.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Returns the length of a texel's two sides on the screen, in pixels, on the receiver's plane: the aliasing error m of
/// both axes of a map (Eisemann et al. 2009, equation 3.2, with all its factors; Lloyd et al. 2008). More than 1:
/// undersampled.
glm::dvec2 aliasing_error(const FittedFace& face, const SeenReceiver& receiver, const visibility::ViewSamples& samples,
                          std::size_t pixel, const LightBasis& basis, std::uint32_t size, const SceneSpace& space = {});

/// Largest error counted: a larger one means that a surface is seen edge-on, from the eye or from the light.
inline constexpr double kMostAliasing = 1e6;

/// Returns whether a view sample faces away from the light's centre. Such a sample is dark without a map.
bool faces_away(const visibility::ViewSamples& samples, std::size_t pixel, const LightBasis& basis);

/// For each pixel the larger m of both axes, 0 where there is no look-up; and counters: aliasingPixels, the number of
/// pixels with a look-up; undersampledPixels, those with m > 1; aliasingThousandths and aliasingWorstThousandths, the
/// sum of m and the largest m, in thousandths; outsidePixels, held by no face (there are none; they would be lit); and
/// neededTexels, the sum over faces of size² · (largest m along a) · (largest m along b): with as many texels no m is
/// above 1. neededTexels divided by the map's texels is the storage factor of the course notes' figure 3.13.
struct Aliasing {
  std::vector<float> errors;
  std::map<std::string, std::uint64_t> counters;
};
Aliasing measure_aliasing(std::span<const FittedFace> faces, const visibility::SceneFloats& scene,
                          const visibility::Light& light, const visibility::ViewSamples& samples,
                          const LightBasis& basis, std::uint32_t size, const SceneSpace& space = {});

}  // namespace penumbra::maps
