// SPDX-License-Identifier: Apache-2.0
// Averages pictures, with weights of a pixel filter.

#include "app/pictures/picture_mean.hpp"

#include "base/assert.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::app {

PictureMean::PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter)
    : width_(width),
      height_(height),
      filter_(filter),
      shares_(std::size_t{width} * height, 0),
      alpha_(std::size_t{width} * height, 0) {}

std::size_t PictureMean::number_of(const std::string& light) {
  const auto known = std::ranges::find(lights_, light);
  if (known != lights_.end()) return static_cast<std::size_t>(known - lights_.begin());
  lights_.push_back(light);
  visibility_.emplace_back(alpha_.size(), 0);
  beauty_.emplace_back(alpha_.size(), glm::dvec3(0));
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
  tbb::parallel_for(first_row, end_row, [&](std::size_t y) {
    for (std::size_t x = 0; x < width_; ++x) {
      const std::size_t pixel = y * width_ + x;
      for (std::size_t row = 0; row < down[y].shares.size(); ++row) {
        const std::size_t first = (down[y].first + row - band.first_sample_row) * width + across[x].first;
        for (std::size_t column = 0; column < across[x].shares.size(); ++column) {
          const double share = down[y].shares[row] * across[x].shares[column];
          const std::size_t from = first + column;
          shares_[pixel] += share;
          alpha_[pixel] += share * double{alpha[from]};
          for (std::size_t light = 0; light < visibility.size(); ++light) {
            visibility_[numbers[light]][pixel] += share * double{visibility[light][from]};
            if (!beauty[light].empty()) beauty_[numbers[light]][pixel] += share * glm::dvec3(beauty[light][from]);
          }
        }
      }
    }
  });
}

std::vector<std::vector<float>> PictureMean::visibility(std::span<const std::string> lights) const {
  std::vector<std::vector<float>> means(lights.size(), std::vector<float>(alpha_.size(), 0));
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = static_cast<std::size_t>(std::ranges::find(lights_, lights[light]) - lights_.begin());
    for (std::size_t i = 0; number < lights_.size() && i < alpha_.size(); ++i)
      means[light][i] = static_cast<float>(visibility_[number][i] / shares_[i]);
  }
  return means;
}

std::vector<std::vector<glm::vec3>> PictureMean::beauty(std::span<const std::string> lights) const {
  std::vector<std::vector<glm::vec3>> means(lights.size(), std::vector<glm::vec3>(alpha_.size(), glm::vec3(0)));
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = static_cast<std::size_t>(std::ranges::find(lights_, lights[light]) - lights_.begin());
    for (std::size_t i = 0; number < lights_.size() && i < alpha_.size(); ++i)
      means[light][i] = glm::vec3(beauty_[number][i] / shares_[i]);
  }
  return means;
}

std::vector<float> PictureMean::alpha() const {
  std::vector<float> mean;
  for (std::size_t i = 0; i < alpha_.size(); ++i) mean.push_back(static_cast<float>(alpha_[i] / shares_[i]));
  return mean;
}

}  // namespace penumbra::app
