// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: functions of texels, stored so that means over windows take a fixed number of fetches.
// prefilter.hpp describes them.
#ifndef PENUMBRA_MAPS_PREFILTER
#define PENUMBRA_MAPS_PREFILTER
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// Functions of a texel's height t, 0 at the nearest caster and 1 at the deepest receiver, all of them in [0, 1].
const uint kLayer = 0;    // x = clamp(a t - b, 0, 1); its square is taken about the middle: (x - 1/2)^2
const uint kRising = 1;   // exp(a (t - 1))
const uint kFalling = 2;  // exp(-a t)
const uint kSine = 3;     // 1/2 + sin(a t) / 2
const uint kCosine = 4;   // 1/2 + cos(a t) / 2
const uint kBit = 5;      // bit a of the texel's word

const uint kPlain = 0;
const uint kSquared = 1;
const uint kTimesHeight = 2;  // with kSine and kCosine: 1/2 + t sin(a t) / 2

struct PrefilterValue {
  uint kind, power;
  float a, b;
  uint first_block;  // first of its blocks
  uint limbs, bits;  // of a table: number of digits and their bits, the highest digit first; 0 bits: the value is 0 or
                     // 1
};

const uint kTable = 0;    // summed areas of digits
const uint kPyramid = 1;  // mip levels
const uint kWindows = 2;  // N-buffer: level l has the mean of the 2^l squared texels that begin at each texel

const uint kPrefilterBuffers = 4;

struct PrefilterTable {
  uint scheme, size, faces, levels;
  uint block;       // words of a block: one limb of a table, or all levels of a value
  uint per_buffer;  // blocks in each buffer
  uint value_count;
};

struct PrefilterLevelPush {
  uint scheme, size, faces;
  uint level;  // level to be computed
  uint from;   // beginning of the previous level in a block
  uint to;     // beginning of this level
  uint block, blocks;
};

struct PrefilterValuesPush {
  uint texels;  // number of texels of all faces
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_PREFILTER
