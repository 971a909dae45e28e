#pragma once

#include "bench/cpu.hpp"
#include "bench/options.hpp"
#include "render/device.hpp"

#include <functional>

namespace penumbra::bench {

/// --wedges-per-frame: what a light that moves needs anew each frame (volumes/raster/wedge_builder.hpp: facings,
/// silhouettes, wedges, and the lists that volumes are counted by), built by the device and by its twin on the
/// processor, in turns on the same places of the light; on knots of growing size. Seconds are those of one frame.
/// Throws std::logic_error if the two find different silhouettes.
void measure_frames(const Options& options, const render::Device& device,
                    const std::function<void(const CpuEntry&)>& sink);

}  // namespace penumbra::bench
