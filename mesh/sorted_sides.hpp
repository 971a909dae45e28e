#pragma once

#include "base/pages.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// For each position the first one with the same coordinates (−0 = +0). In parallel, in linear time.
std::vector<std::uint32_t> merge_equal(std::span<const glm::dvec3> positions);
std::vector<std::uint32_t> merge_equal(std::span<const glm::vec3> positions);

/// A side of a triangle, among those that leave one vertex for a later one.
struct SortedSide {
  std::uint32_t other;   ///< the later vertex
  std::uint32_t number;  ///< 3 · triangle + the corner that it runs from, to the next

  friend auto operator<=>(const SortedSide&, const SortedSide&) = default;
};

/// The sides of all triangles, grouped by edge: what edge graphs are made of.
struct SortedSides {
  std::vector<std::uint32_t> first;  ///< of each vertex, into `sides`; and one past the last's end
  UnsetList<SortedSide> sides;       ///< of a vertex by `other`, then by number

  [[nodiscard]] std::span<const SortedSide> from(std::size_t vertex) const {
    return std::span(sides).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

/// `vertex`: for each position its vertex, the number of a position. Sides of triangles that repeat a vertex are none.
/// At most 2³² / 3 triangles. In parallel, in time and memory linear in the triangles.
SortedSides sort_sides(std::span<const std::uint32_t> vertex, std::span<const Triangle> triangles);

}  // namespace penumbra::mesh
