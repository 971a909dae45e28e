#include "app/pictures/picture_mean.hpp"

#include "base/assert.hpp"

#include <algorithm>

namespace penumbra::app {

PictureMean::PictureMean(std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), alpha_(std::size_t{width} * height, 0) {}

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
                      std::uint32_t side) {
  const std::size_t width = std::size_t{width_} * side;
  PENUMBRA_ASSERT(alpha.size() == width * height_ * side && visibility.size() == lights.size(),
                  "{} view samples of {} lights for {}x{} blocks of {} of {}", alpha.size(), visibility.size(), width_,
                  height_, side, lights.size());
  std::vector<std::size_t> numbers;
  for (const std::string& light : lights) numbers.push_back(number_of(light));
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const std::size_t x = i % width / side, y = i / width / side, pixel = y * width_ + x;
    alpha_[pixel] += double{alpha[i]};
    for (std::size_t light = 0; light < visibility.size(); ++light) {
      visibility_[numbers[light]][pixel] += double{visibility[light][i]};
      if (!beauty[light].empty()) beauty_[numbers[light]][pixel] += glm::dvec3(beauty[light][i]);
    }
  }
  blocks_ += static_cast<double>(side) * side;
}

std::vector<std::vector<float>> PictureMean::visibility(std::span<const std::string> lights) const {
  std::vector<std::vector<float>> means(lights.size(), std::vector<float>(alpha_.size(), 0));
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = static_cast<std::size_t>(std::ranges::find(lights_, lights[light]) - lights_.begin());
    for (std::size_t i = 0; number < lights_.size() && i < alpha_.size(); ++i)
      means[light][i] = static_cast<float>(visibility_[number][i] / blocks_);
  }
  return means;
}

std::vector<std::vector<glm::vec3>> PictureMean::beauty(std::span<const std::string> lights) const {
  std::vector<std::vector<glm::vec3>> means(lights.size(), std::vector<glm::vec3>(alpha_.size(), glm::vec3(0)));
  for (std::size_t light = 0; light < lights.size(); ++light) {
    const auto number = static_cast<std::size_t>(std::ranges::find(lights_, lights[light]) - lights_.begin());
    for (std::size_t i = 0; number < lights_.size() && i < alpha_.size(); ++i)
      means[light][i] = glm::vec3(beauty_[number][i] / blocks_);
  }
  return means;
}

std::vector<float> PictureMean::alpha() const {
  std::vector<float> mean;
  for (const double sum : alpha_) mean.push_back(static_cast<float>(sum / blocks_));
  return mean;
}

}  // namespace penumbra::app
