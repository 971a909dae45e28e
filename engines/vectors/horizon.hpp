#pragma once

#include "engines/vectors/frame.hpp"
#include "engines/vectors/masks.hpp"

#include <cstdint>

/// Masks without casters: all or nothing, and what p's own plane leaves of them. Inside engines/vectors/ only, but for
/// methods' own stages.
namespace penumbra::native {

/// All light samples, or none.
void fill(const Frame& frame, bool visible, Seen& seen);
/// Light samples that are not strictly above the carrier's plane are not visible. (bound horizon)
void cut_at_horizon(const Frame& frame, const Placed& at, Open& open, Seen& seen);
/// Where nothing is before the light but the horizon, and what is open already.
void see_all(const Frame& frame, const Placed& at, Open& open, Judge& judge, Seen& seen);

}  // namespace penumbra::native
