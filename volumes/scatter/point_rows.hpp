#pragma once

#include "volumes/scatter/point_rows.shared.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Light samples anywhere on a light, for scatter_points.comp: row r has those whose y, in cells, is within half a cell
/// of r, from left to right in slots, of which each row has as many as the longest, rounded up to fours.
struct PointRows {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t rows = 0, columns = 0;     ///< cells of the light's frame: the rows, and about as many columns
  std::uint32_t fours = 0;                 ///< of slots, in a row
  std::vector<std::uint32_t> sample_of{};  ///< of each slot; kNone: no light sample
  std::vector<glm::vec4> places{};  ///< of each four slots their x and their y in cells; x of no light sample 1e30
  std::vector<std::uint32_t>
      starts{};  ///< of each row and half cell, left to right: the four with the first at or after it
};

/// `coordinates`: (s, t) of light samples, in [−1, 1]². About √N rows; more where a row would have more than
/// `most_fours`, which it has all the same if too many light samples are of one height.
PointRows make_point_rows(std::span<const glm::vec2> coordinates, std::uint32_t most_fours);

}  // namespace penumbra::volumes
