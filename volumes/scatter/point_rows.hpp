// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/scatter/point_rows.shared.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Arbitrary light samples of a light, for scatter_points.comp: row r has those whose y, in cells, is within half a
/// cell of r, from left to right in slots; each row has as many slots as the longest, rounded up to a multiple of four.
struct PointRows {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t rows = 0, columns = 0;     ///< cells of the light's frame: the rows, and about as many columns
  std::uint32_t fours = 0;                 ///< slots of a row, in fours
  std::vector<std::uint32_t> sample_of{};  ///< for each slot; kNone: no light sample
  std::vector<glm::vec4> places{};  ///< for each four slots their x and their y in cells; x of empty slots is 1e30
  std::vector<std::uint32_t>
      starts{};  ///< for each row and half cell, left to right: the four slots with the first sample at or after it
};

/// Makes about √N rows of N light samples; more rows if one would have more than `most_fours` times four slots. Too
/// many light samples of the same height exceed this limit. `coordinates`: (s, t) of the light samples, in [−1, 1]².
PointRows make_point_rows(std::span<const glm::vec2> coordinates, std::uint32_t most_fours);

}  // namespace penumbra::volumes
