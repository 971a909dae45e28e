#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <span>

namespace penumbra::volumes {

/// A corner of a volume's face: a point, or a direction, which is the point infinitely far that way.
struct FaceCorner {
  glm::dvec3 at{0};  ///< relative to the scene's origin
  bool infinite = false;
};

/// A rectangle on the screen, turned as suits what it holds: its corners in pixels from the picture's upper left, as a
/// triangle strip takes them.
struct ScreenBox {
  std::array<glm::vec2, 4> corners;
};

/// Throws InputError for a camera that looks from no point: what is drawn here is drawn in perspective.
void require_perspective(const visibility::PinholeCamera& camera);

/// Where the rasteriser has to look for the pixels of a face. It only proposes: shaders decide (volumes/README.md,
/// Counting).
class BoxFinder {
 public:
  explicit BoxFinder(const visibility::PinholeCamera& camera);

  /// Holds every pixel whose centre is within an eighth of a pixel of the projection of the convex polygon (three or
  /// four corners, its part behind the eye left out), cut to the screen. Empty: no pixel.
  [[nodiscard]] std::optional<ScreenBox> around(std::span<const FaceCorner> polygon) const;

  /// Where x appears, in pixels; only for what is in front of the eye.
  [[nodiscard]] glm::dvec2 project(const glm::dvec3& x) const;
  /// Whether x appears within a sixteenth of a pixel of there, along either axis: boxes and footprints have room for an
  /// eighth.
  [[nodiscard]] bool appears_at(const glm::dvec3& x, const glm::dvec2& there) const;

 private:
  glm::dvec3 eye_, across_, upward_, forward_;  // of a frustum of half-width and half-height 1
  glm::dvec2 half_;                             // half the picture, in pixels
};

}  // namespace penumbra::volumes
