// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Divides directions of equal power into `parts` parts of equal power, or as many as there are directions (Debevec
/// 2005, "A median cut algorithm for light probe sampling"). A part is cut across its longer side, by angle: the extent
/// in height is compared with the extent around times the cosine of the height. Returns lists of indices. `axes`: the
/// third is up.
std::vector<std::vector<std::uint32_t>> median_cut(std::span<const glm::vec3> directions,
                                                   const std::array<glm::vec3, 3>& axes, std::uint32_t parts);

}  // namespace penumbra::maps
