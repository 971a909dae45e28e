// SPDX-License-Identifier: Apache-2.0
// Light samples of LightSampleBands' buffer, in their order. Includers define SAMPLE_BANDS first, the buffer's binding.
#include "maps/backprojection/patches/light_sample_bands.shared.h"

layout(scalar, binding = SAMPLE_BANDS) readonly buffer Bands {
  SampleBandsHead bands;
  uint band_words[];
};

uint light_sample_count() { return bands.samples; }
vec2 light_sample(uint j) { return uintBitsToFloat(uvec2(band_words[2 * j], band_words[2 * j + 1])); }
