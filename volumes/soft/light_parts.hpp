// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::volumes {

/// Returns a rectangle cut into n × n equal rectangles, each a light without samples: stored in floats, so that
/// neighbours meet to within an ulp of their coordinates. n = 1: the light itself.
std::vector<visibility::Light> light_parts(const visibility::Light& light, std::uint32_t n);

}  // namespace penumbra::volumes
