#pragma once

#include "app/pictures/pixel_filter.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// The mean of several pictures, or of larger ones whose view samples a filter weighs.
class PictureMean {
 public:
  /// Of so many pixels.
  PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter = {});
  /// A picture of `side` times the width and height, the same for all.
  /// Lights are who their names say, whatever their places; where one is missing, it counts as 0.
  void add(std::span<const float> alpha, const std::vector<std::string>& lights,
           std::span<const std::vector<float>> visibility, std::span<const std::vector<glm::vec3>> beauty,
           std::uint32_t side);

  /// All that were added, in the order in which they came.
  [[nodiscard]] const std::vector<std::string>& lights() const { return lights_; }
  [[nodiscard]] std::vector<std::vector<float>> visibility(std::span<const std::string> lights) const;
  [[nodiscard]] std::vector<std::vector<glm::vec3>> beauty(std::span<const std::string> lights) const;
  [[nodiscard]] std::vector<float> alpha() const;

 private:
  /// Its number; one that nobody has added yet is added, dark.
  std::size_t number_of(const std::string& light);

  std::uint32_t width_, height_;
  PixelFilter filter_;
  std::vector<std::string> lights_;
  // Of each pixel: sums, in double, row by row of its view samples, so that cores do not matter; of shares, first.
  std::vector<double> shares_;
  std::vector<std::vector<double>> visibility_;
  std::vector<std::vector<glm::dvec3>> beauty_;
  std::vector<double> alpha_;
};

}  // namespace penumbra::app
