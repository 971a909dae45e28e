// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/pixel_filter.hpp"
#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Rows of a picture, and the first row of the view samples that are given for them.
struct PictureBand {
  visibility::Tile rows;               ///< of pixels
  std::uint32_t first_sample_row = 0;  ///< of the whole picture's view samples
};

/// Mean of several pictures, or of larger ones whose view samples are weighted by a filter.
class PictureMean {
 public:
  /// How often rows are added.
  enum class Adds : std::uint8_t {
    often,  ///< sums are kept in double
    once,   ///< each row is added once: only its means are kept, with the same bits in less than half of the memory
  };
  /// Size in pixels.
  PictureMean(std::uint32_t width, std::uint32_t height, const PixelFilter& filter = {}, Adds adds = Adds::often);
  /// Adds rows of a picture of `side` times the width and height, with the same `side` for all: `band.rows`, from all
  /// view samples within the filter's reach of them, and perhaps more. Lights are identified by name, not position; a
  /// missing light counts as 0.
  void add(std::span<const float> alpha, const std::vector<std::string>& lights,
           std::span<const std::vector<float>> visibility, std::span<const std::vector<glm::vec3>> beauty,
           std::uint32_t side, const PictureBand& band);

  /// Returns all added lights, in the order of their first addition.
  [[nodiscard]] const std::vector<std::string>& lights() const { return lights_; }
  /// Return the means of these lights, 0 of a light that was never added. Each light is returned by move: once.
  std::vector<std::vector<float>> take_visibility(std::span<const std::string> lights);
  std::vector<std::vector<glm::vec3>> take_beauty(std::span<const std::string> lights);
  std::vector<float> take_alpha();

 private:
  /// Returns the light's index; adds a new light with V and beauty 0.
  std::size_t number_of(const std::string& light);
  /// Returns the light's index; nullopt for a light that was never added.
  [[nodiscard]] std::optional<std::size_t> known_number_of(const std::string& light) const;

  std::uint32_t width_, height_;
  PixelFilter filter_;
  Adds adds_;
  std::vector<std::string> lights_;
  /// Sums for each pixel, in double, row by row of its view samples, independent of the number of cores. For rows that
  /// are added once, only the means are kept, divided in double and rounded.
  struct Sums {
    std::vector<double> shares, alpha;
    std::vector<std::vector<double>> visibility;
    std::vector<std::vector<glm::dvec3>> beauty;
  };
  struct Means {
    std::vector<float> alpha;
    std::vector<std::vector<float>> visibility;
    std::vector<std::vector<glm::vec3>> beauty;
  };
  Sums sums_;
  Means means_;
};

}  // namespace penumbra::session
