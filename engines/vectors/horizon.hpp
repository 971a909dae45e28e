#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"

#include <cstdint>

/// Masks without casters: all or none visible, less what is below p's own plane. For engines/vectors/ and the stages of
/// methods.
namespace penumbra::vectors {

/// All light samples, or none.
void fill(const LightGrid& grid, bool visible, SampleMask& mask);
/// Light samples that are not strictly above the carrier's plane are not visible. The mask counts its bits, before and
/// after. (bound horizon)
void cut_at_horizon(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask);
/// The mask of a view sample with no triangle between it and the light: everything above its horizon is visible. What
/// is open already is decided.
void see_all(const LightGrid& grid, const GridSample& at, Open& open, OpenJudge& judge, SampleMask& mask);

}  // namespace penumbra::vectors
