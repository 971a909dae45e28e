// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <span>

namespace penumbra::volumes {

/// A corner of a volume's face: a point, or a direction, which is the point at infinity in that direction.
struct FaceCorner {
  glm::dvec3 at{0};  ///< relative to the scene's origin
  bool infinite = false;
};

/// A rectangle on the screen, rotated to fit its content: its corners in pixels from the picture's upper left, in the
/// order of a triangle strip.
struct ScreenBox {
  std::array<glm::vec2, 4> corners;
};

/// Throws InputError for an orthographic camera: volumes are drawn in perspective.
void require_perspective(const visibility::PinholeCamera& camera);

/// Finds the region in which the rasteriser looks for the pixels of a face. The region only proposes pixels; shaders
/// decide (volumes/README.md, Counting).
class BoxFinder {
 public:
  explicit BoxFinder(const visibility::PinholeCamera& camera);

  /// Returns a box that contains every pixel whose centre is within an eighth of a pixel of the projection of the
  /// convex polygon (three or four corners, without its part behind the eye), clipped to the screen. Returns nullopt if
  /// it contains no pixel.
  [[nodiscard]] std::optional<ScreenBox> around(std::span<const FaceCorner> polygon) const;

  /// Returns the projection of x, in pixels; only for points in front of the eye.
  [[nodiscard]] glm::dvec2 project(const glm::dvec3& x) const;
  /// Returns whether x is projected to within a sixteenth of a pixel of `there`, along either axis: boxes and
  /// footprints have a margin of an eighth.
  [[nodiscard]] bool appears_at(const glm::dvec3& x, const glm::dvec2& there) const;

 private:
  glm::dvec3 eye_, across_, upward_, forward_;  // axes of a frustum of half-width and half-height 1
  glm::dvec2 half_;                             // half the picture, in pixels
};

}  // namespace penumbra::volumes
