#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// The mean of several pictures, or of blocks of pixels of larger ones.
class PictureMean {
 public:
  /// Of so many pixels.
  PictureMean(std::uint32_t width, std::uint32_t height);
  /// A picture of `side` times the width and height: each block counts as much as any other block of any picture.
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
  double blocks_ = 0;  // that were added, in view samples of a pixel
  std::vector<std::string> lights_;
  std::vector<std::vector<double>> visibility_;  // sums, in double: order matters to no digit that is kept
  std::vector<std::vector<glm::dvec3>> beauty_;
  std::vector<double> alpha_;
};

}  // namespace penumbra::app
