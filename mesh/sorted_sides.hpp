// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// Returns for each position the first position with the same coordinates (−0 = +0). In parallel, in linear time.
std::vector<std::uint32_t> merge_equal(std::span<const glm::dvec3> positions);
std::vector<std::uint32_t> merge_equal(std::span<const glm::vec3> positions);

/// A side of a triangle, stored at the lower of its two vertices.
struct SortedSide {
  std::uint32_t other;   ///< the higher vertex
  std::uint32_t number;  ///< 3 · triangle + the corner where the side begins

  friend auto operator<=>(const SortedSide&, const SortedSide&) = default;
};

/// The sides of all triangles, grouped by edge; edge graphs are built from them.
struct SortedSides {
  std::vector<std::uint32_t> first;  ///< begin of each vertex in `sides`, and the end of the last
  UnsetList<SortedSide> sides;       ///< sides of a vertex sorted by `other`, then by number

  [[nodiscard]] std::span<const SortedSide> from(std::size_t vertex) const {
    return std::span(sides).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

/// Sorts the sides of all triangles. `vertex`: for each position its vertex, the index of a position. Triangles that
/// repeat a vertex have no sides. At most 2³² / 3 triangles. In parallel, in time and memory linear in the triangles.
SortedSides sort_sides(std::span<const std::uint32_t> vertex, std::span<const Triangle> triangles);

}  // namespace penumbra::mesh
