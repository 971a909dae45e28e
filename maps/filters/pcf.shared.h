// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of pcf.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// PcfPush::weights.
const uint kEqual = 0, kGaussian = 1, kBilinear = 2;

// Values of PcfPush::test.
const uint kByDepth = 0, kByObject = 1, kByMeanDepth = 2;

struct PcfPush {
  uint window;     // texels on a side
  uint weights;    // kEqual ...
  uint taps;       // number of taps spread over the window, rotated at every receiver; 0: all of its texels
  uint stages;     // stages of taps; 2: the outermost taps decide if they agree
  uint test;       // kByDepth ...
  uint keep;       // number of texels of extreme depths in the window that are compared; 0: all
  float softness;  // kByMeanDepth: distance behind the mean depth at which the receiver is dark, as a fraction of its
                   // depth
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
