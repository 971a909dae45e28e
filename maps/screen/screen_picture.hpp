// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::maps {

/// View samples of a camera in the eye's space (x to the right, y up, z toward the viewer) as a picture of depths.
class ScreenPicture {
 public:
  ScreenPicture() = default;
  /// Returns nullopt if the view samples are not at the positions of the camera's pixels, such as baked ones.
  static std::optional<ScreenPicture> of(const visibility::ViewSamples& samples);

  /// Returns the position of a point in the picture, in pixels; the centre of pixel (x, y) is (x + ½, y + ½). Returns
  /// nullopt for a point that is not in front of the eye.
  [[nodiscard]] std::optional<glm::dvec2> place_of(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec2 centre_of(std::size_t pixel) const {
    const std::size_t column = pixel % width_, row = pixel / width_;
    return glm::dvec2(column, row) + 0.5;
  }
  /// Returns the pixel at a place; nullopt outside the picture, and where the picture shows background.
  [[nodiscard]] std::optional<std::size_t> surface_at(const glm::dvec2& place) const;
  [[nodiscard]] bool holds(const glm::dvec2& place) const {
    return place.x >= 0 && place.y >= 0 && place.x < width_ && place.y < height_;
  }
  /// Returns the number of pixels of a unit length across the view at this distance along the view axis.
  [[nodiscard]] double pixels_per_length(double distance) const;

  [[nodiscard]] bool shows_surface(std::size_t pixel) const { return shown_[pixel] != 0; }
  [[nodiscard]] const glm::dvec3& point(std::size_t pixel) const { return points_[pixel]; }
  [[nodiscard]] const glm::dvec3& normal(std::size_t pixel) const { return normals_[pixel]; }
  [[nodiscard]] std::size_t size() const { return shown_.size(); }
  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }

 private:
  visibility::PinholeCamera camera_;
  glm::dvec2 shift_{0};  ///< direction of the middle of a perspective picture: (shift_, −1)
  std::uint32_t width_ = 0, height_ = 0;
  std::vector<glm::dvec3> points_, normals_;
  std::vector<std::uint8_t> shown_;
};

}  // namespace penumbra::maps
