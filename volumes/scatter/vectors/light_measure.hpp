// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/textured_part.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>

#include <cstddef>
#include <optional>

/// Measure of a part of a light's window: rows=exact of edge scatter. Inside volumes/ only.
namespace penumbra::volumes {

/// A part of the window between two heights: x of its left and right side at both heights, in cells.
struct Trapezoid {
  struct Row {
    double y = 0, left = 0, right = 0;
  };
  Row low, high;
};

/// Measures parts of a light's window, a grid of `size` cells: for a rectangle or polygon their area, for a round light
/// the area inside the disk, for a textured one the texture's luminance over its mean.
class LightMeasure {
 public:
  LightMeasure(const visibility::Light& light, const glm::dvec2& size);

  /// Returns whether the measure is the area for all parts.
  [[nodiscard]] bool plain() const { return !round_ && !texture_; }
  /// Returns the measure of a trapezoid with sides of double precision; its error is `rounding()` in addition to that
  /// of a plain area.
  [[nodiscard]] double of(const Trapezoid& part) const;
  [[nodiscard]] double whole() const { return whole_; }
  /// Sets the measure of a polygon, whose outline counts as layers (RowSum).
  void set_whole(double cells) { whole_ = cells; }
  /// Returns the largest ratio of a part's measure to its area.
  [[nodiscard]] double densest() const { return densest_; }
  [[nodiscard]] double rounding() const;

 private:
  [[nodiscard]] double in_disk(const Trapezoid& part) const;
  [[nodiscard]] double under_texture(const Trapezoid& part) const;

  glm::dvec2 size_;
  bool round_;
  double whole_, densest_ = 1;
  std::optional<areas::TexturedPart> texture_;
};

}  // namespace penumbra::volumes
