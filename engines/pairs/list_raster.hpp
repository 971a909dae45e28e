// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_pixels.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::pairs {

/// View samples in lists of light pixels, and their depths, for the triangles drawn over them.
struct ListRaster {
  LightPixels& grid;
  std::span<const double> depths;  ///< depth of each place: grows with the distance from the light
  std::span<const std::uint32_t> triangles;
};

struct ListCounts {
  std::uint64_t footprints = 0;  ///< pairs (triangle, band of rows) that were scan-converted
  std::uint64_t lists = 0;       ///< pairs (triangle, light pixel) whose lists were traversed
};

/// Draws triangles conservatively. `footprint_of(triangle)` returns the region in which the triangle may hide anything;
/// `nearest_of(triangle)` a lower bound of the depths of all places that it hides anything from. For each place (its
/// index) in the lists of touched light pixels, `stays(triangle, number, state)` is called; false removes the place
/// from its list for good. Bands of rows are drawn in parallel, each with its own `State`, which is passed to
/// `finish(state)` at the end of the band; calls of `finish` do not overlap.
template <typename State, typename FootprintOf, typename NearestOf, typename Stays, typename Finish>
ListCounts draw(const ListRaster& in, const FootprintOf& footprint_of, const NearestOf& nearest_of, const Stays& stays,
                const Finish& finish) {
  constexpr std::uint32_t kBands = 96;
  LightPixels& grid = in.grid;
  std::vector<PixelRange> rows(in.triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Footprint footprint = footprint_of(in.triangles[i]);
      if (footprint.count > 0 || footprint.everywhere) rows[i] = grid.rows_of(grid.hull_of(footprint));
    }
  });
  ListCounts counts;
  std::mutex finishing;
  const auto draw_band = [&](PixelRange band, State& state, ListCounts& own) {
    const std::size_t first = std::size_t{band.first} * grid.columns();
    // For each list: the number of places left, and the depth of the deepest.
    std::vector<std::uint32_t> left((band.last + std::size_t{1}) * grid.columns() - first);
    std::vector<double> deepest(left.size(), -std::numeric_limits<double>::max());
    for (std::size_t at = 0; at < left.size(); ++at) {
      const auto list = grid.list(static_cast<std::uint32_t>((first + at) / grid.columns()),
                                  static_cast<std::uint32_t>((first + at) % grid.columns()));
      left[at] = static_cast<std::uint32_t>(list.size());
      for (const std::uint32_t number : list) deepest[at] = std::max(deepest[at], in.depths[number]);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const PixelRange touched{std::max(rows[i].first, band.first), std::min(rows[i].last, band.last)};
      if (rows[i].none() || touched.none()) continue;
      ++own.footprints;
      const std::uint32_t triangle = in.triangles[i];
      const PixelHull hull = grid.hull_of(footprint_of(triangle));
      const double nearest = nearest_of(triangle);
      for (std::uint32_t row = touched.first; row <= touched.last; ++row) {
        const PixelRange columns = grid.columns_of(hull, row);
        for (std::uint32_t column = columns.first; !columns.none() && column <= columns.last; ++column) {
          const std::size_t at = std::size_t{row} * grid.columns() + column - first;
          if (left[at] == 0 || nearest > deepest[at]) continue;
          ++own.lists;
          const auto list = grid.list(row, column);
          for (std::uint32_t k = left[at]; k-- > 0;) {
            if (!stays(triangle, list[k], state)) std::swap(list[k], list[--left[at]]);
          }
        }
      }
    }
  };
  const std::uint32_t height = grid.rows(), bands = std::min(height, kBands);
  tbb::parallel_for(std::uint32_t{0}, bands, [&](std::uint32_t band) {
    State state;
    ListCounts own;
    draw_band({height * band / bands, height * (band + 1) / bands - 1}, state, own);
    const std::lock_guard lock(finishing);
    counts.footprints += own.footprints;
    counts.lists += own.lists;
    finish(state);
  });
  return counts;
}

}  // namespace penumbra::pairs
