#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Debevec 2005, "A median cut algorithm for light probe sampling": directions of equal power in so many parts of equal
/// power, or as many as there are directions. A part is cut across its longer side, by angle: how far it reaches in
/// height, or around times the cosine of its height. The result is lists of indices. `axes`: the third is up.
std::vector<std::vector<std::uint32_t>> median_cut(std::span<const glm::vec3> directions,
                                                   const std::array<glm::vec3, 3>& axes, std::uint32_t parts);

}  // namespace penumbra::maps
