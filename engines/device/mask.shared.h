// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL (scalar layout): data between the host of mask methods and their kernels.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::device::gpu {
using uint = std::uint32_t;
#endif

// Head of a list of questions: their number, including questions for which there was no space; and whether a driver
// ended a kernel's loop too soon.
struct QuestionHead {
  uint count;
  uint cut_off;
};

// Bits of a word of a pixel's mask that exact predicates decided.
struct MaskWord {
  uint pixel;  // pixel of the tile; | kWholePixel: the old word is invalid
  uint word;   // index of the word in the buffer of masks
  uint decided;
  uint bits;
};

const uint kWholePixel = 0x80000000u;

// Values of OpenBits::hider (open_judge.hpp) that are not the index of a triangle.
const uint kCarrier = 0xfffffffeu;      // p's own triangle: the question is whether the light sample is above the
                                        // horizon
const uint kAnyTriangle = 0xffffffffu;  // any triangle: the question is whether the light sample is visible

#ifdef __cplusplus
}  // namespace penumbra::device::gpu
#endif
