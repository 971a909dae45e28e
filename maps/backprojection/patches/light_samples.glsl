// The light samples of LightSampleBands' buffer, in their order. Before it is included SAMPLE_BANDS is its binding.
#include "maps/backprojection/patches/light_sample_bands.shared.h"

layout(scalar, binding = SAMPLE_BANDS) readonly buffer Bands {
  SampleBandsHead bands;
  uint band_words[];
};

uint light_sample_count() { return bands.samples; }
vec2 light_sample(uint j) { return uintBitsToFloat(uvec2(band_words[2 * j], band_words[2 * j + 1])); }
