// Shared by C++ and GLSL: push constants of pcf.comp after LookupPush.
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
  uint taps;     // number spread over the window, rotated at every receiver; 0: all texels of the window
  uint stages;   // of taps; 2: the outermost decide if all of them agree
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
