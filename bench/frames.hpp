// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/cpu.hpp"
#include "bench/options.hpp"
#include "render/device.hpp"

#include <functional>

namespace penumbra::bench {

/// Times --wedges-per-frame: the structures rebuilt in each frame for a light that moves
/// (volumes/raster/wedge_builder.hpp: facings, silhouettes, wedges, and the lists from which volumes are counted). The
/// device and its twin on the processor build these in turns, for the same positions of the light, on knots of growing
/// size. Seconds are those of one frame. Throws std::logic_error if the two find different silhouettes.
void measure_frames(const Options& options, const render::Device& device,
                    const std::function<void(const CpuEntry&)>& sink);

}  // namespace penumbra::bench
