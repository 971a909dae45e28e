// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace penumbra::vectors {

/// Rounding error of a triangle's determinant |D|, in units of |d| R³, below which the places where rays meet the
/// triangle are unknown: scan_conversion.cpp.
inline constexpr double kScanNoise = 0x1p-38;

/// Triangles that may cover pixels, in ascending order: for each its pixel centres, both ends included, and a lower
/// bound of all its t (0: unknown). Where `left` is kOpen, float arithmetic could not decide.
struct PixelBoxes {
  static constexpr std::size_t kMost = 512;  ///< triangles in one call
  static constexpr std::size_t kRoom = kMost + 16;
  static constexpr std::int32_t kOpen = -1;

  std::size_t count = 0;
  std::array<std::uint32_t, kRoom> triangle;
  std::array<std::int32_t, kRoom> left, right, top, bottom;
  std::array<float, kRoom> nearest;
};

/// Mapping of directions to pixels of a camera's rows.
struct Screen {
  explicit Screen(const visibility::PinholeCamera& camera);

  glm::dvec2 size;    ///< pixels
  double scale;       ///< pixels for a unit of slope, y down
  glm::dvec2 middle;  ///< pixel coordinates of slope 0
  double longest_ray;
};

/// A camera and its screen in float. All lengths are times `unit`, a power of two, so that camera and scene lie within
/// ±1 and no product overflows.
struct BoxCamera {
  BoxCamera(const visibility::SceneFloats& scene, const visibility::PinholeCamera& camera, const Screen& screen);

  bool is_usable = false;  ///< all numbers are in the range that floats can handle
  float unit = 1;
  glm::vec3 eye{0}, eye_rest{0};  ///< the eye is their sum
  glm::vec3 right{0}, down{0}, forward{0};
  glm::vec2 middle{0};  ///< as in Screen
  glm::vec2 last{0};    ///< last pixel
  float scale = 1, longest_ray = 1;
};

/// Finds those of the triangles [first, end), at most kMost of them, that may cover pixels: a vector of triangles at a
/// time.
void find_boxes(const visibility::SceneFloats& scene, const BoxCamera& camera, std::size_t first, std::size_t end,
                PixelBoxes& boxes);

}  // namespace penumbra::vectors
