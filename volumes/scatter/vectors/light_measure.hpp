#pragma once

#include "areas/textured_part.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>

#include <cstddef>
#include <optional>

/// How much of a light a part of its window is: rows=exact of edge scatter. Inside volumes/ only.
namespace penumbra::volumes {

/// A part of the window between two of its rows: x of its two sides at both, in cells.
struct Trapezoid {
  struct Row {
    double y = 0, left = 0, right = 0;
  };
  Row low, high;
};

/// Weighs parts of a light's window, a grid of `size` cells: of a rectangle or polygon by their area, of a round light
/// by the area that is in the disk, of a textured one by the texture's luminance over its mean.
class LightMeasure {
 public:
  LightMeasure(const visibility::Light& light, const glm::dvec2& size);

  /// Are all parts weighed by their area?
  [[nodiscard]] bool plain() const { return !round_ && !texture_; }
  /// Of a trapezoid with sides of double precision; off by `rounding()` beside what a plain area is.
  [[nodiscard]] double of(const Trapezoid& part) const;
  [[nodiscard]] double whole() const { return whole_; }
  /// Of a polygon, whose outline is layers (RowSum).
  void set_whole(double cells) { whole_ = cells; }
  /// At most so much more than its area does any part weigh.
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
