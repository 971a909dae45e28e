// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"
#include "compare/metrics.hpp"

#include <cstdint>
#include <optional>
#include <span>

/// Perceived errors of a picture, as a complement of RMSE.
namespace penumbra::compare {

/// One of the 255 steps of a picture's byte: V with a smaller error is shown at the right step or at a neighbouring
/// one.
inline constexpr double kShown = 1.0 / 255;

struct EyeError {
  double over255 = 0;  ///< fraction of pixels with |e| > 1/255
  /// √ of the mean of (e − e of the neighbour)², over pairs of horizontally or vertically adjacent pixels that are both
  /// in the penumbra: steps and noise where the reference is smooth. Empty: there are no such pairs.
  std::optional<double> banding;
};

/// Returns the errors e = V − V of the reference over these pixels (ascending); `penumbra`: the pixels among these with
/// partial visibility. Returns nullopt if there are no pixels.
std::optional<EyeError> eye_error(const JudgedVisibility& light, std::span<const std::uint32_t> penumbra,
                                  std::uint32_t width);

/// FLIP, a difference close to the one perceived by an observer alternating between two pictures: P. Andersson, J.
/// Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: a difference evaluator for alternating
/// images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), 2020. From 0 (none) to 1.
struct Flip {
  double mean = 0, max = 0;
};
/// Pixels in a degree of the observer's field of view: a screen 0.7 m wide with 3840 pixels, from 0.7 m away.
inline constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

/// Return FLIP of each pixel, and its mean and maximum; both pictures must have the same size and not be empty.
std::vector<float> flip_map(const Image8& reference, const Image8& picture,
                            double pixels_per_degree = kPixelsPerDegree);
Flip flip_of(const Image8& reference, const Image8& picture);

}  // namespace penumbra::compare
