// Shared by C++ and GLSL: push constants of pcf.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// PcfPush::weights.
const uint kEqual = 0, kGaussian = 1, kBilinear = 2;

// PcfPush::test.
const uint kByDepth = 0, kByObject = 1, kByMeanDepth = 2;

struct PcfPush {
  uint window;     // texels on a side
  uint weights;    // kEqual ...
  uint taps;       // spread over the window, turned at every receiver; 0: all of its texels
  uint stages;     // of taps; 2: the outermost decide if they agree
  uint test;       // kByDepth ...
  uint keep;       // so many texels of the window, those of extreme depths, are compared; 0: all
  float softness;  // kByMeanDepth: how far behind the mean depth it is dark, as a share of the receiver's depth
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
