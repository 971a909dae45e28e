// SPDX-License-Identifier: Apache-2.0
// Tests the cut at a view sample's horizon, on masks of light samples in rows and in tiles.

#include "engines/vectors/horizon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::vectors {
namespace {

struct Places {
  LightGrid grid;
  std::vector<glm::dvec2> st;  // place of each light sample, in half sides of the light
};

Places in_rows(std::uint32_t rows, std::uint32_t columns, std::mt19937& random) {
  Places made;
  LightGrid& grid = made.grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.padded_rows = (rows + 15) / 16 * 16;
  grid.sample_count = rows * columns;
  grid.half_cells = 0.5F * glm::vec2(columns, rows);
  grid.first_cell = grid.half_cells - 0.5F;
  grid.shift.resize(grid.padded_rows);
  for (float& shift : grid.shift) shift = std::uniform_real_distribution<float>(-0.5F, 0.5F)(random);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const glm::dvec2 cell(static_cast<double>(column) + static_cast<double>(grid.shift[row]), row);
      made.st.push_back((cell - glm::dvec2(grid.first_cell)) / glm::dvec2(grid.half_cells));
    }
  }
  return made;
}

Places in_tiles(std::uint32_t count, std::mt19937& random) {
  Places made;
  LightGrid& grid = made.grid;
  grid.sample_count = count;
  grid.half_cells = glm::vec2(0.5F * std::round(std::sqrt(static_cast<float>(count))));
  grid.first_cell = grid.half_cells - 0.5F;
  std::uniform_real_distribution<float> side(-1, 1);
  std::vector<glm::vec2> cells(count);
  for (glm::vec2& at : cells) at = grid.first_cell + grid.half_cells * glm::vec2(side(random), side(random));
  for (const glm::vec2& at : cells)
    made.st.push_back((glm::dvec2(at) - glm::dvec2(grid.first_cell)) / glm::dvec2(grid.half_cells));
  grid.tiles = make_light_tiles(cells);
  return made;
}

/// Expects that samples above the horizon by more than the error keep their bits, samples below it are cleared, and
/// those within the error are cleared and listed as open.
void expect_cut(const Places& places, const GridSample& at, std::mt19937& random) {
  const LightGrid& grid = places.grid;
  std::vector<std::uint16_t> bits(mask_words(grid)), before;
  SampleMask mask{bits.data(), 0};
  fill(grid, true, mask);
  for (std::uint16_t& word : bits)
    word = static_cast<std::uint16_t>(word & random() & 0xffffU);  // as if casters hid some
  mask.count(bits.size());
  before = bits;
  Open open;
  cut_at_horizon(grid, at, open, mask);
  const glm::dvec3 above(at.above);
  // The float sums are wrong by six roundings of at most four times these terms.
  const double error = static_cast<double>(at.above_error),
               off = 0x1p-19 * (std::abs(above.x) + std::abs(above.y) + std::abs(above.z));
  std::uint32_t visible = 0;
  for (std::uint32_t j = 0; j < grid.sample_count; ++j) {
    const double value = above.x * places.st[j].x + above.y * places.st[j].y + above.z;
    const std::size_t bit = mask_bit(grid, j);
    const bool was = (before[bit / 16] >> bit % 16 & 1) != 0, is = (bits[bit / 16] >> bit % 16 & 1) != 0;
    const bool is_open = std::ranges::find(open.samples, j) != open.samples.end();
    visible += is ? 1 : 0;
    if (value > error + off) {
      EXPECT_TRUE(is == was && !is_open) << j;
    } else {
      EXPECT_FALSE(is && value < error - off) << j;
    }
    EXPECT_FALSE(is_open && value < -error - off) << j;
    EXPECT_FALSE(!is_open && was && !is && value > -error + off) << j;
  }
  EXPECT_EQ(mask.visible, visible);
}

TEST(Horizon, CutsLightSamples) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(-1, 1);
  for (int once = 0; once < 300; ++once) {
    GridSample at;
    at.straddles = true;
    at.above = {any(random), any(random), any(random)};
    if (once % 5 == 0) at.above.x = 0;
    if (once % 7 == 0) at.above.y = 0;
    at.above_error = once % 3 == 0 ? 0.05F : 1e-6F;
    const auto some = [&](std::uint32_t most) { return static_cast<std::uint32_t>(1 + random() % most); };
    expect_cut(in_rows(some(40), some(40), random), at, random);
    expect_cut(in_tiles(some(1500), random), at, random);
    if (HasFailure()) FAIL() << "of set " << once;
  }
}

}  // namespace
}  // namespace penumbra::vectors
