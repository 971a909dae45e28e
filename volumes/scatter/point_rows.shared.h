// One struct, two languages (scalar layout): what the device knows of light samples anywhere, and asks about them.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

// Light samples that are tested together, side by side in a row. Slots are numbered four after four along a row, row
// after row; a slot is a bit of the mask.
const uint kPointsAtOnce = 4;
// Rows whose slots are whole words of masks, however many they are.
const uint kPointRowsAtOnce = 8;
const uint kStartsPerCell = 2;  // places along a row from which on the first light sample is known

// Slots that float arithmetic left open of a pixel (of the tile): `bits` of a word of its mask. With kWholePixel: all
// light samples of `words` words from this one on, and nothing of them is in the mask yet. As large as a RowQuestion:
// one list holds either.
struct PointQuestion {
  uint pixel, word, bits, words;
  uint unused_1, unused_2;
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
