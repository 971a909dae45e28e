// SPDX-License-Identifier: Apache-2.0
// Averages pictures, with weights of a pixel filter.

#include "session/pictures/picture_mean.hpp"

#include "base/assert.hpp"
#include "base/pages.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::session {
namespace {

/// Sums over the view samples of one row of pixels, weighted by the filter: down each column of view samples first,
/// whose values lie side by side in memory, and then across. A sum's order of additions depends on the filter alone, so
/// that the sum over equal values v is v times the sum of weights, to the bit where v is 0 or 1.
class WeightedRow {
 public:
  /// `first`: the row's first row of view samples, counted from the first given one. All other arguments must outlive
  /// this object.
  WeightedRow(const FilterTaps& down, std::span<const FilterTaps> across, std::size_t first, std::uint32_t side)
      : down_(down), across_(across), first_(first), side_(side) {}

  /// Adds the weights of each pixel.
  void add_shares(std::span<double> sums) const {
    double column = 0;
    for (const double share : down_.shares) column += share;
    for (std::size_t x = 0; x < sums.size(); ++x) {
      double sum = 0;
      for (const double share : across_[x].shares) sum += share * column;
      sums[x] += sum;
    }
  }

  /// Add to each pixel the weighted sum of its view samples' values; `values`: of all given rows.
  void add(std::span<const float> values, std::span<double> sums) const {
    const std::vector<double> columns = down_columns(values.data(), 1);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      double sum = 0;
      const double* column = columns.data() + across_[x].first;
      for (const double share : across_[x].shares) sum += share * *column++;
      sums[x] += sum;
    }
  }
  void add(std::span<const glm::vec3> values, std::span<glm::dvec3> sums) const {
    const std::vector<double> columns = down_columns(&values.data()->x, 3);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      glm::dvec3 sum(0);
      const double* column = columns.data() + 3 * across_[x].first;
      for (const double share : across_[x].shares) {
        sum += share * glm::dvec3(column[0], column[1], column[2]);
        column += 3;
      }
      sums[x] += sum;
    }
  }

 private:
  /// Returns the weighted sum down each column of view samples of `numbers` numbers each.
  [[nodiscard]] std::vector<double> down_columns(const float* values, std::size_t numbers) const {
    std::vector<double> columns(across_.size() * side_ * numbers, 0.0);
    const float* row = values + first_ * columns.size();
    for (const double share : down_.shares) {
      for (std::size_t i = 0; i < columns.size(); ++i) columns[i] += share * double{row[i]};
      row += columns.size();
    }
    return columns;
  }

  const FilterTaps& down_;
  std::span<const FilterTaps> across_;
  std::size_t first_;
  std::uint32_t side_;
};

}  // namespace

PictureMean::PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter, Adds adds)
    : width_(width), height_(height), filter_(filter), adds_(adds) {
  const std::size_t pixels = std::size_t{width} * height;
  if (adds_ == Adds::once) {
    means_.alpha.resize(pixels);
    return;
  }
  sums_.shares.resize(pixels);
  sums_.alpha.resize(pixels);
}

std::optional<std::size_t> PictureMean::known_number_of(const std::string& light) const {
  const auto known = std::ranges::find(lights_, light);
  if (known == lights_.end()) return std::nullopt;
  return static_cast<std::size_t>(known - lights_.begin());
}

std::size_t PictureMean::number_of(const std::string& light) {
  if (const auto known = known_number_of(light)) return *known;
  const std::size_t pixels = std::size_t{width_} * height_;
  lights_.push_back(light);
  if (adds_ == Adds::once) {
    resize_on_all_cores(means_.visibility.emplace_back(), pixels);
    resize_on_all_cores(means_.beauty.emplace_back(), pixels);
  } else {
    resize_on_all_cores(sums_.visibility.emplace_back(), pixels);
    resize_on_all_cores(sums_.beauty.emplace_back(), pixels);
  }
  return lights_.size() - 1;
}

void PictureMean::add(std::span<const float> alpha, const std::vector<std::string>& lights,
                      std::span<const std::vector<float>> visibility, std::span<const std::vector<glm::vec3>> beauty,
                      std::uint32_t side, const PictureBand& band) {
  const std::size_t width = std::size_t{width_} * side, rows = alpha.size() / width;
  PENUMBRA_ASSERT(alpha.size() == width * rows && visibility.size() == lights.size(),
                  "{} view samples of {} lights for rows of {} blocks of {} of {}", alpha.size(), visibility.size(),
                  width_, side, lights.size());
  std::vector<std::size_t> numbers;
  for (const std::string& light : lights) numbers.push_back(number_of(light));
  const std::vector<FilterTaps> across = filter_taps(filter_, width_, side), down = filter_taps(filter_, height_, side);
  const auto first_row = std::size_t{band.rows.first_row}, end_row = first_row + band.rows.row_count;
  const FilterTaps &first_taps = down.at(first_row), &last_taps = down.at(end_row - 1);
  PENUMBRA_ASSERT(first_taps.first >= band.first_sample_row &&
                      last_taps.first + last_taps.shares.size() <= band.first_sample_row + rows,
                  "rows {} to {} from {} rows of view samples from {} on", first_row, end_row, rows,
                  band.first_sample_row);
  const bool once = adds_ == Adds::once;
  tbb::parallel_for(first_row, end_row, [&](std::size_t y) {
    const WeightedRow row(down[y], across, down[y].first - band.first_sample_row, side);
    std::vector<double> shares_of(width_, 0.0);
    row.add_shares(shares_of);
    const auto pixels = [&](auto& all) { return std::span(all).subspan(y * width_, width_); };
    const auto divided = [&](std::span<const double> sums, auto means) {
      for (std::size_t x = 0; x < width_; ++x) means[x] = static_cast<float>(sums[x] / shares_of[x]);
    };
    std::vector<double> sums(once ? width_ : 0);
    std::vector<glm::dvec3> sums_of_three(once ? width_ : 0);
    if (once) {
      row.add(alpha, sums);
      divided(sums, pixels(means_.alpha));
    } else {
      for (std::size_t x = 0; x < width_; ++x) sums_.shares[y * width_ + x] += shares_of[x];
      row.add(alpha, pixels(sums_.alpha));
    }
    for (std::size_t light = 0; light < visibility.size(); ++light) {
      const std::size_t number = numbers[light];
      if (!once) {
        row.add(visibility[light], pixels(sums_.visibility[number]));
        if (!beauty[light].empty()) row.add(beauty[light], pixels(sums_.beauty[number]));
        continue;
      }
      std::ranges::fill(sums, 0.0);
      row.add(visibility[light], sums);
      divided(sums, pixels(means_.visibility[number]));
      if (beauty[light].empty()) continue;
      std::ranges::fill(sums_of_three, glm::dvec3(0));
      row.add(beauty[light], sums_of_three);
      for (std::size_t x = 0; x < width_; ++x)
        means_.beauty[number][y * width_ + x] = glm::vec3(sums_of_three[x] / shares_of[x]);
    }
  });
}

std::vector<std::vector<float>> PictureMean::take_visibility(std::span<const std::string> lights) {
  const std::size_t pixels = std::size_t{width_} * height_;
  std::vector<std::vector<float>> means(lights.size());
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = known_number_of(lights[light]);
    if (number && adds_ == Adds::once) {
      means[light] = std::move(means_.visibility[*number]);
      continue;
    }
    means[light].resize(pixels);
    if (!number) continue;
    const std::vector<double> sums = std::move(sums_.visibility[*number]);
    for (std::size_t i = 0; i < pixels; ++i) means[light][i] = static_cast<float>(sums[i] / sums_.shares[i]);
  }
  return means;
}

std::vector<std::vector<glm::vec3>> PictureMean::take_beauty(std::span<const std::string> lights) {
  const std::size_t pixels = std::size_t{width_} * height_;
  std::vector<std::vector<glm::vec3>> means(lights.size());
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = known_number_of(lights[light]);
    if (number && adds_ == Adds::once) {
      means[light] = std::move(means_.beauty[*number]);
      continue;
    }
    means[light].assign(pixels, glm::vec3(0));
    if (!number) continue;
    const std::vector<glm::dvec3> sums = std::move(sums_.beauty[*number]);
    for (std::size_t i = 0; i < pixels; ++i) means[light][i] = glm::vec3(sums[i] / sums_.shares[i]);
  }
  return means;
}

std::vector<float> PictureMean::take_alpha() {
  if (adds_ == Adds::once) return std::move(means_.alpha);
  std::vector<float> mean;
  for (std::size_t i = 0; i < sums_.alpha.size(); ++i)
    mean.push_back(static_cast<float>(sums_.alpha[i] / sums_.shares[i]));
  return mean;
}

}  // namespace penumbra::session
