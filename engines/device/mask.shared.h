// One struct, two languages (scalar layout): what the host of mask methods and their kernels tell one another.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::device::gpu {
using uint = std::uint32_t;
#endif

// Where a list of questions begins: how many there are, also where there is no room for them; and whether a driver
// ended a kernel's loop too soon.
struct QuestionHead {
  uint count;
  uint cut_off;
};

// A word of a pixel's mask that exact predicates decided: those bits of it.
struct MaskWord {
  uint pixel;  // of the tile; | kWholePixel: the old word says nothing
  uint word;   // in the buffer of masks
  uint decided;
  uint bits;
};

const uint kWholePixel = 0x80000000u;

// What a light sample may be hidden by, instead of a triangle's number.
const uint kCarrier = 0xfffffffeu;      // p's own triangle: is the light sample above the horizon?
const uint kAnyTriangle = 0xffffffffu;  // is it visible at all?

#ifdef __cplusplus
}  // namespace penumbra::device::gpu
#endif
