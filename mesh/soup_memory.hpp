// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <cstdint>

namespace penumbra::mesh {

/// Returns the memory that a soup takes.
constexpr std::uint64_t soup_bytes(std::uint64_t triangles, std::uint64_t positions) {
  return triangles * (sizeof(Triangle) + 2 * sizeof(std::uint32_t)) + positions * sizeof(glm::dvec3);
}

}  // namespace penumbra::mesh
