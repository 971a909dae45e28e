// One struct, two languages: what pcf.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// PcfPush::weights.
const uint kEqual = 0, kGaussian = 1, kBilinear = 2;

struct PcfPush {
  uint window;   // texels on a side
  uint weights;  // kEqual ...
  uint taps;     // spread over the window, turned at every receiver; 0: all of its texels
  uint stages;   // of taps; 2: the outermost decide if they agree
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
