#pragma once

#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// V of few pixels for all: what methods of this room can do that answer pixel by pixel (Guennebaud et al. 2007).
namespace penumbra::maps {

inline constexpr visibility::IntegerOption kSubsample{
    "subsample", 1, 64, 1,
    "V of every so many pixels across and down, and of the others what pull-push makes of them; 1: of every pixel"};

/// The method itself for 1. Else it answers a picture of every `step`-th pixel of every `step`-th row, and of all
/// pixels of objects of which that picture shows none; the others' V is filled in from pixels of the same object
/// (fill_in).
std::unique_ptr<visibility::Method> subsampled(std::unique_ptr<visibility::Method> method, std::uint32_t step);

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
