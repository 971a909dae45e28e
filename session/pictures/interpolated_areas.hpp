// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/asked_areas.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::session {

/// Largest estimated difference between an interpolated V and a view sample's own V: less than half a step of an 8-bit
/// picture.
inline constexpr double kPixelTolerance = 1.0 / 512;

/// Computes areas at several view samples a pixel at little more than the cost of one. The given method evaluates one
/// view sample of each pixel. Four neighbours of these are the corners of a cell; where all view samples of a cell lie
/// on one smooth surface and the curvature of V, and of the arriving light, is small from corner to corner, the cell's
/// other view samples are interpolated. The curvature along x and y is measured by the second difference over three
/// neighbouring pixels, D: for a function whose second derivative is bounded, the error of bilinear interpolation is at
/// most (|Dx| + |Dy|) / 8, which must be below the tolerance. In a cell of several surfaces, none near another, a view
/// sample takes the value of a corner on its own surface, with the slope there, if |Dx| + |Dy|, the error of the slope
/// within a pixel, is below the tolerance, and the cell's other corners on this surface agree. Everywhere else the
/// method evaluates each view sample. V has kinks where edges of casters are parallel to edges of the light, and a
/// caster may be so thin that its shadow passes between the corners: there the bound is an estimate (measured errors:
/// docs/pictures.md).
///
/// All arguments must outlive this object.
class InterpolatedAreas final : public AskedAreas {
 public:
  /// `side`: view samples of a pixel along each axis, at least 2; prepare_view() requires a picture of whole pixels.
  /// `tolerance`: of V, above 0.
  InterpolatedAreas(visibility::Method& method, const visibility::SceneFloats& scene, std::uint32_t side,
                    double tolerance);

  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  /// `touching`: several surfaces so near to one another that a contact shadow may begin between corners.
  enum class Cell : std::uint8_t { touching, apart, bent, smooth };
  /// Curvature of the answers at a corner along x and y, as an error of V; NaN if a neighbour is on another surface.
  struct Bend {
    float x, y;
  };
  /// Results near a corner, as a linear function of pixels across and down, and its largest error within a pixel.
  struct Slope {
    double share, share_x, share_y;
    glm::dvec3 factor, factor_x, factor_y;
    float error;
  };
  [[nodiscard]] std::size_t corner_of(std::uint32_t x, std::uint32_t y) const;
  [[nodiscard]] bool on_one_surface(std::size_t one, std::size_t other) const;
  [[nodiscard]] float bend(std::size_t before, std::size_t at, std::size_t after, std::uint32_t step_in_fine) const;
  [[nodiscard]] bool are_apart(std::size_t first) const;
  [[nodiscard]] Cell cell_of(std::uint32_t column, std::uint32_t row) const;
  [[nodiscard]] std::optional<Slope> slope(std::uint32_t x, std::uint32_t y) const;
  /// Returns the answer at a view sample of the fine picture, from the nearest corner on its surface that allows it.
  [[nodiscard]] std::optional<AreaAnswer> from_corner(std::uint32_t x, std::uint32_t y) const;
  void look_at_corners();
  void find_cells();
  /// Interpolates, and counts the view sample as viewSamplesInterpolated.
  std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) override;

  const visibility::SceneFloats& scene_;
  std::uint32_t side_;
  double tolerance_;
  const visibility::ViewSamples* fine_ = nullptr;
  std::uint32_t width_ = 0, height_ = 0;  // of corners
  bool has_corners_ = false;              // for the current light and view
  std::vector<AreaAnswer> corners_;
  std::vector<Bend> bends_;  // of each corner
  std::vector<Cell> cells_;  // row by row: (width_ − 1) · (height_ − 1)
};

}  // namespace penumbra::session
