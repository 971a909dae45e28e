#pragma once

#include "app/pictures/pixel_filter.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Mean of several pictures, or of larger ones whose view samples are weighted by a filter.
class PictureMean {
 public:
  /// Size in pixels.
  PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter = {});
  /// Adds a picture of `side` times the width and height, with the same `side` for all. Lights are identified by name,
  /// not position; a missing light counts as 0.
  void add(std::span<const float> alpha, const std::vector<std::string>& lights,
           std::span<const std::vector<float>> visibility, std::span<const std::vector<glm::vec3>> beauty,
           std::uint32_t side);

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
