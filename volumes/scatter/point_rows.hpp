// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/scatter/point_rows.shared.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Arbitrary light samples of a light, for scatter_points.comp. Row r has the samples whose y, in cells, is within half
/// a cell of r, stored from left to right in slots. Each row has as many slots as the longest row, rounded up to a
/// multiple of four.
struct PointRows {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t rows = 0, columns = 0;     ///< size of the grid of cells over the light's frame
  std::uint32_t fours = 0;                 ///< number of slots of a row, divided by four
  std::vector<std::uint32_t> sample_of{};  ///< for each slot; kNone: no light sample
  std::vector<glm::vec4> places{};  ///< for each four slots, their x and then their y in cells; x of empty slots is
                                    ///< 1e30
  std::vector<std::uint32_t>
      starts{};  ///< for each row and half cell, left to right: the four slots with the first sample at or after it
};

/// Makes about √N rows of N light samples; more rows if one would have more than `most_fours` times four slots. This
/// limit is exceeded if too many light samples have the same height. `coordinates`: (s, t) of the light samples, in
/// [−1, 1]².
PointRows make_point_rows(std::span<const glm::vec2> coordinates, std::uint32_t most_fours);

}  // namespace penumbra::volumes
