// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

/// Places of edges for one view sample, in vectors of doubles. Inside volumes/ only.
namespace penumbra::volumes {

/// Data of a view sample: members of RowSum with the same names.
struct PlacesFrame {
  glm::dvec3 p{0};
  std::array<glm::dvec3, 3> axes{};
  glm::dvec2 foot{0}, middle{0}, size{0};  ///< middle and size of the window, in cells
  double height = 0, per_length = 0, skew = 0, error_foot = 0, error_height = 0;
  bool ends = false;  ///< whether segments end at the light's height, as for a sphere
};

/// A few edges, and their places.
struct WidePlaces {
  static constexpr std::size_t kMost = 64;
  using Column = std::array<double, kMost>;
  enum How : std::uint8_t {
    kUnplaced,  ///< must be clipped, or is near p's height: RowSum::place handles it
    kBeside,    ///< outside of the light: ignored
    kCrossing,  ///< may extend beyond the light, or its error is large
    kInside,    ///< inside the light, and away from its corner
  };

  alignas(64) std::array<Column, 3> a{};  ///< x, y, z
  alignas(64) std::array<Column, 3> b{};
  alignas(64) Column x0{}, y0{}, x1{}, y1{}, error{};
  std::array<How, kMost> how{};
  std::array<std::int32_t, kMost> k{};  ///< set by the caller, as is `slot`
  std::array<std::uint32_t, kMost> slot{};
  std::size_t count = 0;
};

/// Computes, for edges that need no clipping, which are nearly all, the places and errors of RowSum::place, bit for
/// bit.
void place_side_by_side(const PlacesFrame& frame, WidePlaces& places);

}  // namespace penumbra::volumes
