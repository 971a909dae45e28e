// SPDX-License-Identifier: Apache-2.0
// Records summed-area tables (Crow 1984): rows, then columns (summed_areas.comp).

#include "maps/products/summed_areas.hpp"

#include "maps/products/summed_areas.comp.spv.hpp"
#include "maps/products/summed_areas.shared.h"

namespace penumbra::maps {

SummedAreas::SummedAreas(const render::Device& device)
    : pass_(device, {.name = "summed areas",
                     .spirv = shaders::kSummedAreasComp,
                     .push_bytes = sizeof(gpu::SummedAreasPush),
                     .constants = {}}) {}

void SummedAreas::record(render::Commands& commands, const render::Buffer& buffer, std::uint32_t images,
                         std::uint32_t size) const {
  for (const std::uint32_t columns : {0U, 1U}) {
    const gpu::SummedAreasPush push{size, images * size, columns};
    pass_.record(commands, push, {buffer}, (std::uint64_t{push.lines} + 63) / 64);
  }
}

}  // namespace penumbra::maps
