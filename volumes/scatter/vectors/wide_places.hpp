#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

/// Where edges appear to one view sample, in double, side by side. Inside volumes/ only.
namespace penumbra::volumes {

/// Of a view sample: what RowSum has, by the same names.
struct PlacesFrame {
  glm::dvec3 p{0};
  std::array<glm::dvec3, 3> axes{};
  glm::dvec2 foot{0}, middle{0}, size{0};  ///< middle and size of the window, in cells
  double height = 0, per_length = 0, skew = 0, error_foot = 0, error_height = 0;
  bool ends = false;  ///< ways end at the light's height, as a sphere's do
};

/// Some edges: where they are, and where that appears.
struct WidePlaces {
  static constexpr std::size_t kMost = 64;
  using Column = std::array<double, kMost>;
  enum How : std::uint8_t {
    kUnplaced,  ///< it has to be cut, or is near p's height: RowSum::place
    kBeside,    ///< the light: it counts nowhere
    kCrossing,  ///< it may reach beyond the light, or its error be large
    kInside,    ///< the light, and away from its corner
  };

  alignas(64) std::array<Column, 3> a{};  ///< x, y, z
  alignas(64) std::array<Column, 3> b{};
  alignas(64) Column x0{}, y0{}, x1{}, y1{}, error{};
  std::array<How, kMost> how{};
  std::array<std::int32_t, kMost> k{};  ///< the caller's, as the next
  std::array<std::uint32_t, kMost> slot{};
  std::size_t count = 0;
};

/// Of those that need no cutting, which are nearly all, the places and errors that RowSum::place finds, bit for bit.
void place_side_by_side(const PlacesFrame& frame, WidePlaces& places);

}  // namespace penumbra::volumes
