#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::reference {

/// The light samples in an order in which neighbours in the list are neighbours on the light (Morton order of their
/// coordinates): rays that run together are traced faster. Only an order of work; masks keep the light samples'.
std::vector<std::uint32_t> tracing_order(const visibility::Light& light);

}  // namespace penumbra::reference
