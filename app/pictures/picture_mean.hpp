// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/pictures/pixel_filter.hpp"
#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Rows of a picture, and where the rows of view samples begin that are given for them.
struct PictureBand {
  visibility::Tile rows;               ///< of pixels
  std::uint32_t first_sample_row = 0;  ///< of the whole picture's view samples
};

/// Mean of several pictures, or of larger ones whose view samples are weighted by a filter.
class PictureMean {
 public:
  /// Size in pixels.
  PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter = {});
  /// Adds rows of a picture of `side` times the width and height, with the same `side` for all: `band.rows`, from all
  /// view samples within the filter's reach of them, and perhaps more. Lights are identified by name, not position; a
  /// missing light counts as 0.
  void add(std::span<const float> alpha, const std::vector<std::string>& lights,
           std::span<const std::vector<float>> visibility, std::span<const std::vector<glm::vec3>> beauty,
           std::uint32_t side, const PictureBand& band);

  /// Returns all added lights, in the order of their first addition.
  [[nodiscard]] const std::vector<std::string>& lights() const { return lights_; }
  [[nodiscard]] std::vector<std::vector<float>> visibility(std::span<const std::string> lights) const;
  [[nodiscard]] std::vector<std::vector<glm::vec3>> beauty(std::span<const std::string> lights) const;
  [[nodiscard]] std::vector<float> alpha() const;

 private:
  /// Returns the light's index; adds a new light with V and beauty 0.
  std::size_t number_of(const std::string& light);

  std::uint32_t width_, height_;
  PixelFilter filter_;
  std::vector<std::string> lights_;
  // Sums for each pixel, in double, row by row of its view samples, independent of the number of cores; `shares_`
  // first.
  std::vector<double> shares_;
  std::vector<std::vector<double>> visibility_;
  std::vector<std::vector<glm::dvec3>> beauty_;
  std::vector<double> alpha_;
};

}  // namespace penumbra::app
