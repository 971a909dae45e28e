// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// V of few pixels, extended to all: for methods of this room that evaluate pixel by pixel (Guennebaud et al. 2007).
namespace penumbra::maps {

inline constexpr visibility::IntegerOption kSubsample{
    "subsample", 1, 64, 1,
    "largest step, in pixels across and down, between pixels whose V is computed; the others are filled by pull-push; "
    "1: every pixel is computed"};
enum class SubsampleBy : std::uint8_t { penumbra, grid };
inline constexpr visibility::ChoiceOption kSubsampleBy{
    "subsampleBy",
    {{"penumbra", SubsampleBy::penumbra}, {"grid", SubsampleBy::grid}},
    SubsampleBy::penumbra,
    "step of subsample: by the width of penumbrae on the screen, or the same everywhere"};

/// Smallest number of computed pixels across the narrowest penumbra, with SubsampleBy::penumbra.
inline constexpr double kPixelsAcross = 4;

/// Returns the method itself if `options` request every pixel. Otherwise the returned method evaluates the pixels in
/// every step-th row and column, and all pixels of objects missed by this grid; the V of the other pixels is filled in
/// from pixels of the same object (fill_in). The step is kSubsample's, or each pixel's own: the largest power of two
/// that is not above kSubsample's and leaves kPixelsAcross pixels across the narrowest possible penumbra there
/// (penumbra_width.hpp); 1 where nothing can hide light, because the method finds this quickly. A method that returns
/// masks then returns V alone.
std::unique_ptr<visibility::Method> subsampled(const render::Device& device, std::unique_ptr<visibility::Method> method,
                                               const visibility::ParsedOptions& parsed,
                                               const visibility::MethodOptions& options);

/// V of a pixel if computed, and the object visible at the pixel.
struct KnownPixel {
  static constexpr std::uint32_t kNothing = 0xffffffffu;
  std::uint32_t object = kNothing;  ///< kNothing: not requested
  bool known = false;
  float v = 1;
};

/// Fills in V by pull-push (Gortler et al. 1996, section 3.4) in pictures `width` wide, up to 2²⁰ pixels a side, for
/// all pixels of an object with at least one known pixel. A pixel of a coarser level is the mean of the known pixels of
/// its four children of the same object, at the mean of their positions; unknown pixels are interpolated between pixels
/// of the next coarser level.
void fill_in(std::span<KnownPixel> pixels, std::uint32_t width);

}  // namespace penumbra::maps
