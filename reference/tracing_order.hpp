// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::reference {

/// Returns the light samples in an order in which neighbours in the list are neighbours on the light (Morton order of
/// their coordinates): rays that are traced together are then faster. Affects the order of work only; masks keep the
/// order of light samples.
std::vector<std::uint32_t> tracing_order(const visibility::Light& light);

}  // namespace penumbra::reference
