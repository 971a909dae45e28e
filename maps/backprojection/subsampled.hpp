#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// V of few pixels for all: what methods of this room can do that answer pixel by pixel (Guennebaud et al. 2007).
namespace penumbra::maps {

inline constexpr visibility::IntegerOption kSubsample{
    "subsample", 1, 64, 1,
    "V of no more than every so many pixels across and down, and of the others what pull-push makes of them; 1: of "
    "every pixel"};
enum class SubsampleBy : std::uint8_t { penumbra, grid };
inline constexpr visibility::ChoiceOption kSubsampleBy{
    "subsampleBy",
    {{"penumbra", SubsampleBy::penumbra}, {"grid", SubsampleBy::grid}},
    SubsampleBy::penumbra,
    "which pixels subsample leaves out: as many as penumbrae are wide on the screen, or the same everywhere"};

/// Pixels across the narrowest penumbra that are computed at least, by SubsampleBy::penumbra.
inline constexpr double kPixelsAcross = 4;

/// The method itself where `options` ask for every pixel. Else it answers a picture of the pixels in every step-th row
/// and column, and of all pixels of objects of which that picture shows none; the others' V is filled in from pixels of
/// the same object (fill_in). The step is kSubsample's, or each pixel's own: the largest power of two that is not above
/// it, and leaves kPixelsAcross pixels across the narrowest penumbra there may be (penumbra_width.hpp); 1 where nothing
/// can hide light, for the method sees that at once. What gives masks gives V alone then.
std::unique_ptr<visibility::Method> subsampled(const render::Device& device, std::unique_ptr<visibility::Method> method,
                                               const visibility::ParsedOptions& parsed,
                                               const visibility::MethodOptions& options);

/// A pixel's V if it was computed; which object it shows.
struct KnownPixel {
  static constexpr std::uint32_t kNothing = 0xffffffffu;
  std::uint32_t object = kNothing;  ///< kNothing: not asked for
  bool known = false;
  float v = 1;
};

/// Pull-push (Gortler et al. 1996, section 3.4) of pictures `width` wide, up to 2²⁰ pixels a side: V of all pixels that
/// show an object of which some pixel is known. A pixel of a coarser level is the mean of what is known in its four of
/// that object, at the mean of their places; what is not known lies between pixels of the next coarser level.
void fill_in(std::span<KnownPixel> pixels, std::uint32_t width);

}  // namespace penumbra::maps
