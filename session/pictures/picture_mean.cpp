// SPDX-License-Identifier: Apache-2.0
// Averages pictures, with weights of a pixel filter.

#include "session/pictures/picture_mean.hpp"

#include "base/assert.hpp"
#include "base/pages.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::session {

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
  // Sums stay in registers from tap to tap; each is added up in the order of its taps, whatever is summed beside it.
  tbb::parallel_for(first_row, end_row, [&](std::size_t y) {
    const FilterTaps& rows_of = down[y];
    const auto for_each_tap = [&](std::size_t x, auto add) {
      for (std::size_t row = 0; row < rows_of.shares.size(); ++row) {
        const std::size_t from = (rows_of.first + row - band.first_sample_row) * width + across[x].first;
        for (std::size_t column = 0; column < across[x].shares.size(); ++column)
          add(rows_of.shares[row] * across[x].shares[column], from + column);
      }
    };
    const bool once = adds_ == Adds::once;
    std::vector<double> shares_of(once ? width_ : 0);  // of each pixel of the row
    for (std::size_t x = 0; x < width_; ++x) {
      const std::size_t pixel = y * width_ + x;
      double shares = once ? 0 : sums_.shares[pixel], covered = once ? 0 : sums_.alpha[pixel];
      for_each_tap(x, [&](double share, std::size_t from) {
        shares += share;
        covered += share * double{alpha[from]};
      });
      if (once) {
        shares_of[x] = shares;
        means_.alpha[pixel] = static_cast<float>(covered / shares);
      } else {
        sums_.shares[pixel] = shares;
        sums_.alpha[pixel] = covered;
      }
    }
    for (std::size_t light = 0; light < visibility.size(); ++light) {
      const std::span<const float> seen = visibility[light];
      const std::span<const glm::vec3> lit = beauty[light];
      const std::size_t number = numbers[light];
      for (std::size_t x = 0; x < width_; ++x) {
        const std::size_t pixel = y * width_ + x;
        double share_seen = once ? 0 : sums_.visibility[number][pixel];
        glm::dvec3 arriving = once ? glm::dvec3(0) : sums_.beauty[number][pixel];
        if (lit.empty()) {
          for_each_tap(x, [&](double share, std::size_t from) { share_seen += share * double{seen[from]}; });
        } else {
          for_each_tap(x, [&](double share, std::size_t from) {
            share_seen += share * double{seen[from]};
            arriving += share * glm::dvec3(lit[from]);
          });
        }
        if (once) {
          means_.visibility[number][pixel] = static_cast<float>(share_seen / shares_of[x]);
          means_.beauty[number][pixel] = glm::vec3(arriving / shares_of[x]);
        } else {
          sums_.visibility[number][pixel] = share_seen;
          sums_.beauty[number][pixel] = arriving;
        }
      }
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
