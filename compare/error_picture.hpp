#pragma once

#include "base/image.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace penumbra::compare {

/// The colour of pixels that show nothing: between all errors' and (being no grey) no value of V either.
inline constexpr Color8 kBackgroundColor{96, 104, 116};

/// The colour of a signed error: white is right, blue too bright, red too dark, deepest at ±limit and beyond. The
/// depth grows with √(|error| / limit), so that small errors are seen beside large ones.
Color8 error_color(double error, double limit);
/// The colours between which error_color() goes, evenly spaced in depth from right to wrong.
std::span<const Color8> error_colors(bool too_bright);

/// The end of a scale that suits errors up to `largest`: the next of 0.01, 0.02, 0.05, 0.1 … 1 (at least 0.01). To be
/// shared by all pictures that will be looked at side by side.
double error_scale_limit(double largest);

/// V − reference of each pixel by error_color; the background, and where either is NaN (nobody evaluated it), in
/// kBackgroundColor.
Image8 error_picture(const visibility::ViewSamples& samples, std::span<const float> visibility,
                     std::span<const float> reference, double limit);

/// V as grey, 0 black to 1 white, evenly spaced for the eye; the background and NaN in kBackgroundColor.
Image8 visibility_picture(const visibility::ViewSamples& samples, std::span<const float> visibility);

/// A factor for linear colours that makes a picture neither dark nor burnt: the 99th percentile of the largest
/// component of pixels that are not black becomes 0.9 of white. 1 if all are black. `left_out` (empty, or of each
/// pixel): not 0 for pixels that do not count, unless all others are black.
float auto_exposure(std::span<const glm::vec3> linear, std::span<const std::uint8_t> left_out = {});

}  // namespace penumbra::compare
