// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>

namespace penumbra::volumes {

/// Returns (b − a) × (c − a) times a power of two that brings its largest coordinate near 1. Each coordinate is rounded
/// to float from its exact value: signs computed with it are affected by that rounding only, even for needles. Returns
/// 0 only for a triangle without area.
glm::vec3 rounded_normal(const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::volumes
