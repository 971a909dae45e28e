// SPDX-License-Identifier: Apache-2.0
// Sorts arbitrary light samples into rows of similar height with start tables, for scatter_points.comp.

#include "volumes/scatter/point_rows.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr float kNowhere = 1e30F;

using Row = std::vector<std::uint32_t>;

/// Returns the row that height y, in cells, is in. Exact: y is a float, and the half is added in double.
std::uint32_t row_of(float y, std::uint32_t rows) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(static_cast<double>(y) + 0.5), 0.0, rows - 1.0));
}

void add_row(PointRows& all, std::span<const glm::vec2> places, const Row& row) {
  for (std::uint32_t four = 0; four < all.fours; ++four) {
    glm::vec4 x(kNowhere), y(0);
    for (std::uint32_t i = 0; i < gpu::kPointsAtOnce; ++i) {
      const std::size_t slot = std::size_t{four} * gpu::kPointsAtOnce + i;
      const bool is_sample = slot < row.size();
      all.sample_of.push_back(is_sample ? row[slot] : PointRows::kNone);
      if (!is_sample) continue;
      x[static_cast<glm::length_t>(i)] = places[row[slot]].x;
      y[static_cast<glm::length_t>(i)] = places[row[slot]].y;
    }
    all.places.push_back(x);
    all.places.push_back(y);
  }
  for (std::uint32_t start = 0; start < all.columns * gpu::kStartsPerCell; ++start) {
    // Begins slightly to the left: the shader rounds before it looks up.
    const float x = (static_cast<float>(start) - 0x1p-8F) / gpu::kStartsPerCell - 0.5F;
    const auto first = std::ranges::lower_bound(row, x, {}, [&](std::uint32_t j) { return places[j].x; });
    const auto four = static_cast<std::uint32_t>(first - row.begin()) / gpu::kPointsAtOnce;
    all.starts.push_back(std::min(four, all.fours - 1));
  }
}

std::size_t longest(const std::vector<Row>& rows) {
  return std::ranges::max_element(rows, {}, &Row::size)->size();
}

/// Returns the position of each light sample in cells of a grid of `cells.columns` by `cells.rows`.
std::vector<glm::vec2> places_of(std::span<const glm::vec2> coordinates, const PointRows& cells) {
  const glm::dvec2 half(0.5 * cells.columns, 0.5 * cells.rows);
  std::vector<glm::vec2> places;
  places.reserve(coordinates.size());
  for (const glm::vec2& at : coordinates) places.emplace_back(half - 0.5 + half * glm::dvec2(at));
  return places;
}

std::vector<Row> rows_of(std::span<const glm::vec2> places, const PointRows& cells) {
  std::vector<Row> rows(cells.rows);
  for (std::uint32_t j = 0; j < places.size(); ++j) rows[row_of(places[j].y, cells.rows)].push_back(j);
  return rows;
}

}  // namespace

PointRows make_point_rows(std::span<const glm::vec2> coordinates, std::uint32_t most_fours) {
  const auto count = static_cast<double>(coordinates.size());
  PointRows all;
  std::vector<glm::vec2> places;
  std::vector<Row> rows;
  // Starts with square cells, since the error of a place is relative to a cell's shorter side.
  for (double height = 1;; height /= 2) {
    all.rows = static_cast<std::uint32_t>(std::max(1.0, std::round(std::sqrt(count) / height)));
    all.columns = static_cast<std::uint32_t>(std::max(1.0, std::round(count / all.rows)));
    places = places_of(coordinates, all);
    rows = rows_of(places, all);
    if (longest(rows) <= std::size_t{most_fours} * gpu::kPointsAtOnce || all.rows >= count) break;
  }
  for (Row& row : rows) std::ranges::sort(row, {}, [&](std::uint32_t j) { return std::pair(places[j].x, j); });
  all.fours = static_cast<std::uint32_t>((longest(rows) + gpu::kPointsAtOnce - 1) / gpu::kPointsAtOnce);
  for (const Row& row : rows) add_row(all, places, row);
  return all;
}

}  // namespace penumbra::volumes
