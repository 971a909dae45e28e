// SPDX-License-Identifier: Apache-2.0
// Constants and structs shared by C++ and GLSL (scalar layout): arbitrary light samples, and questions about them.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

// Number of light samples that are tested together, side by side in a row. Slots are numbered in fours along a row, row
// after row; each slot is a bit of the mask.
const uint kPointsAtOnce = 4;
// Number of rows whose slots fill whole words of masks, for every row length.
const uint kPointRowsAtOnce = 8;
const uint kStartsPerCell = 2;  // places for each cell of a row at which the first light sample to the right is stored

// A question about slots of a pixel (of the tile) that float arithmetic left open: `bits` of a word of its mask. With
// kWholePixel: all light samples of `words` words from this one on, none of which is in the mask yet. It has the size
// of a RowQuestion, so that one buffer holds either kind.
struct PointQuestion {
  uint pixel, word, bits, words;
  uint unused_1, unused_2;
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
