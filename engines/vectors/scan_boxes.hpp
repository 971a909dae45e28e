#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace penumbra::vectors {

/// Rounding error of a triangle's determinant |D|, in units of |d| R³, up to which nothing is known of where rays meet
/// it: scan_conversion.cpp.
inline constexpr double kScanNoise = 0x1p-38;

/// Triangles that may cover pixels, in ascending order: for each its pixel centres, both ends included, and what no t
/// of it is below (0: nothing known). Where `left` is kOpen, float arithmetic could not say.
struct PixelBoxes {
  static constexpr std::size_t kMost = 512;  ///< triangles of one call
  static constexpr std::size_t kRoom = kMost + 16;
  static constexpr std::int32_t kOpen = -1;

  std::size_t count = 0;
  std::array<std::uint32_t, kRoom> triangle;
  std::array<std::int32_t, kRoom> left, right, top, bottom;
  std::array<float, kRoom> nearest;
};

/// Where a camera's picture has what it looks at.
struct Screen {
  explicit Screen(const visibility::PinholeCamera& camera);

  glm::dvec2 size;    ///< pixels
  double scale;       ///< pixels a unit of slope, y down
  glm::dvec2 middle;  ///< where slope 0 is: pixels
  double longest_ray;
};

/// A camera and its screen as float arithmetic sees them. All lengths are times `unit`, a power of two, so that camera
/// and scene lie within ±1 and no product overflows.
struct BoxCamera {
  BoxCamera(const visibility::SceneFloats& scene, const visibility::PinholeCamera& camera, const Screen& screen);

  bool is_usable = false;  ///< no number is so large or small that floats would not do
  float unit = 1;
  glm::vec3 eye{0}, eye_rest{0};  ///< the eye is their sum
  glm::vec3 right{0}, down{0}, forward{0};
  glm::vec2 middle{0};  ///< as in Screen
  glm::vec2 last{0};    ///< pixel
  float scale = 1, longest_ray = 1;
};

/// The triangles [first, end), at most kMost of them, that may cover pixels: a vector of them at a time.
void find_boxes(const visibility::SceneFloats& scene, const BoxCamera& camera, std::size_t first, std::size_t end,
                PixelBoxes& boxes);

}  // namespace penumbra::vectors
