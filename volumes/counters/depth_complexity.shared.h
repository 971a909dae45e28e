// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL (scalar layout): questions of the depth-complexity pass to the host.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

// A question about light samples of a pixel (of the tile): those of `bits` in word `word` of its mask. With kReference:
// `word` is the index of the one light sample whose ray the whole mask depends on; `bits` is 0. With kAllWords: all
// light samples of the pixel, regardless of other questions about it.
struct DepthQuestion {
  uint pixel;
  uint word;
  uint bits;
};

const uint kReference = 0x80000000u;
const uint kAllWords = 0x7fffffffu;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
