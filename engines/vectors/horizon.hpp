// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"

#include <cstdint>

/// Masks without casters: all or no light samples visible, minus those below p's own plane. For engines/vectors/ and
/// the stages of methods.
namespace penumbra::vectors {

/// Sets all light samples, or none.
void fill(const LightGrid& grid, bool visible, SampleMask& mask);
/// Clears light samples that are not strictly above the carrier's plane. The mask's count must be set before the call,
/// and is updated. (bound horizon of docs/view-sample.md)
void cut_at_horizon(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask);
/// Sets the mask of a view sample with no triangle between it and the light: everything above its horizon is visible.
/// Samples that are already open are decided.
void see_all(const LightGrid& grid, const GridSample& at, Open& open, OpenJudge& judge, SampleMask& mask);

}  // namespace penumbra::vectors
