// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace penumbra::compare {

/// Colour of pixels without a value: distinct from all error colours and, not being a grey, from all values of V.
inline constexpr Color8 kBackgroundColor{96, 104, 116};

/// Returns the colour of a signed error: white is 0, blue too bright, red too dark, deepest at ±limit and beyond. The
/// depth grows with √(|error| / limit), so that small errors are visible next to large ones.
Color8 error_color(double error, double limit);
/// Returns the colours interpolated by error_color(), evenly spaced in depth from 0 to the limit.
std::span<const Color8> error_colors(bool too_bright);

/// Returns the end of a scale for errors up to `largest`: the next of 0.01, 0.02, 0.05, 0.1 … 1 (at least 0.01). To be
/// shared by all pictures shown side by side.
double error_scale_limit(double largest);

/// Returns V − reference of each pixel by error_color; the background, and pixels where either is NaN (not evaluated),
/// in kBackgroundColor.
Image8 error_picture(const visibility::ViewSamples& samples, std::span<const float> visibility,
                     std::span<const float> reference, double limit);

/// Returns V as grey, 0 black to 1 white, perceptually evenly spaced; the background and NaN in kBackgroundColor.
Image8 visibility_picture(const visibility::ViewSamples& samples, std::span<const float> visibility);

/// Returns a factor for linear colours that makes a picture neither dark nor overexposed: the 99th percentile of the
/// largest component of pixels that are not black becomes 0.9 of white. 1 if all are black. `left_out` (empty, or one
/// value for each pixel): not 0 for pixels to be ignored, unless all others are black.
float auto_exposure(std::span<const glm::vec3> linear, std::span<const std::uint8_t> left_out = {});

}  // namespace penumbra::compare
