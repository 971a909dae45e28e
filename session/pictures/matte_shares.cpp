// SPDX-License-Identifier: Apache-2.0
// Sums the coverage of mattes over view samples.

#include "session/pictures/matte_shares.hpp"

#include "base/assert.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace penumbra::session {
namespace {

using Share = MatteShares::Share;

void add_share(std::vector<Share>& shares, std::size_t first, std::uint32_t name, double part) {
  for (std::size_t i = first; i < shares.size(); ++i) {
    if (shares[i].name != name) continue;
    shares[i].part += static_cast<float>(part);
    return;
  }
  shares.push_back({name, static_cast<float>(part)});
}

/// Rows and columns of a block of view samples; `step`: number of view samples in a row of the picture.
struct Block {
  std::size_t rows, columns, step;
};

/// Returns whether all view samples of the block that begins at `corner` have the same name.
bool is_one_name(std::span<const std::uint32_t> of_sample, std::size_t corner, const Block& block) {
  const std::uint32_t name = of_sample[corner];
  for (std::size_t y = 0; y < block.rows; ++y) {
    std::uint32_t others = 0;  // without a branch for each view sample
    for (const std::uint32_t other : of_sample.subspan(corner + y * block.step, block.columns)) others |= other ^ name;
    if (others != 0) return false;
  }
  return true;
}

}  // namespace

MatteShares::MatteShares(std::uint32_t width, std::uint32_t height, const PixelFilter& filter)
    : width_(width), filter_(filter), rows_(height) {
  for (Row& row : rows_) row.ends.resize(width, 0);
}

void MatteShares::add(std::span<const std::string> names, std::span<const std::uint32_t> of_sample, std::uint32_t side,
                      const PictureBand& band) {
  std::vector<std::uint32_t> known;
  for (const std::string& name : names) {
    const auto [number, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    known.push_back(number->second);
  }
  std::vector<std::uint32_t> numbered;
  numbered.reserve(of_sample.size());
  for (const std::uint32_t name : of_sample) numbered.push_back(name == kNothing ? name : known[name]);
  const std::vector<FilterTaps> across = filter_taps(filter_, width_, side),
                                down = filter_taps(filter_, rows_.size(), side);
  const auto first = std::size_t{band.rows.first_row};
  tbb::parallel_for(first, first + band.rows.row_count, [&](std::size_t y) {
    FilterTaps taps = down[y];
    PENUMBRA_ASSERT(taps.first >= band.first_sample_row &&
                        (taps.first - band.first_sample_row + taps.shares.size()) * width_ * side <= numbered.size(),
                    "row {} from {} view samples from row {} on", y, numbered.size(), band.first_sample_row);
    taps.first -= band.first_sample_row;
    add_row(y, numbered, side, taps, across);
  });
}

void MatteShares::add_row(std::size_t y, std::span<const std::uint32_t> of_sample, std::uint32_t side,
                          const FilterTaps& down, std::span<const FilterTaps> across) {
  const Row before = std::exchange(rows_[y], Row{});
  Row& row = rows_[y];
  row.ends.reserve(width_);
  row.shares.reserve(width_);
  const std::size_t step = std::size_t{width_} * side;
  // A pixel that shows one name alone, as most do, gets the same sum as its neighbour with the same weights.
  float whole = 0;
  std::span<const double> whole_of;
  std::size_t begin = 0;
  for (std::size_t x = 0; x < width_; ++x) {
    const std::size_t first = row.shares.size(), corner = down.first * step + across[x].first;
    const bool is_new = before.ends[x] == begin;
    if (is_new && is_one_name(of_sample, corner, {down.shares.size(), across[x].shares.size(), step})) {
      if (!std::ranges::equal(whole_of, across[x].shares)) {
        whole_of = across[x].shares;
        whole = 0;
        for (const double share : down.shares) {
          for (const double other : whole_of) whole += static_cast<float>(share * other);
        }
      }
      row.shares.push_back({of_sample[corner], whole});
      row.ends.push_back(static_cast<std::uint32_t>(row.shares.size()));
      continue;
    }
    row.shares.insert(row.shares.end(), before.shares.begin() + static_cast<std::ptrdiff_t>(begin),
                      before.shares.begin() + before.ends[x]);
    begin = before.ends[x];
    for (std::size_t i = 0; i < down.shares.size(); ++i) {
      const std::size_t from = corner + i * step;
      for (std::size_t k = 0; k < across[x].shares.size(); ++k)
        add_share(row.shares, first, of_sample[from + k], down.shares[i] * across[x].shares[k]);
    }
    row.ends.push_back(static_cast<std::uint32_t>(row.shares.size()));
  }
}

void MatteShares::settle() {
  tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t y) {
    std::size_t begin = 0;
    for (const std::uint32_t end : rows_[y].ends) {
      const auto shares = std::span(rows_[y].shares).subspan(begin, end - begin);
      begin = end;
      float all = 0;
      for (const Share& share : shares) all += share.part;
      std::ranges::stable_sort(shares, [](const Share& a, const Share& b) {
        if (a.name == kNothing || b.name == kNothing) return b.name == kNothing && a.name != kNothing;
        return a.part != b.part ? a.part > b.part : a.name < b.name;
      });
      for (Share& share : shares) share.part /= all;
    }
  });
}

}  // namespace penumbra::session
