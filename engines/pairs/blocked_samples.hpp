// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::pairs {

/// Relative error of a determinant of three differences, per product of its rows' lengths. Each difference has a
/// relative error of 2⁻⁵³ in each coordinate, which gives three such errors. The determinant also rounds six products
/// of three factors, each at most the product of the rows' lengths, and their sums: in all less than 16 · 2⁻⁵³ · 6 of
/// that product (visibility/certain_meeting.cpp). Here one row is itself a sum, w + (o − p), with three more roundings
/// of at most |w| + |o − p|: still below 2⁻⁴⁶ of the product with this sum in place of the row's length.
inline constexpr double kDeterminant = 0x1p-46;

/// Statistics: triangles and pairs by the test that decided them.
struct PairCounts {
  std::uint64_t triangles = 0;  ///< pairs (view sample, triangle) tried
  std::uint64_t missed = 0;     ///< of these, triangles certainly not between p and any part of the light
  std::uint64_t covered = 0;    ///< of these, triangles that certainly hide the whole light
  std::uint64_t pairs = 0;      ///< pairs (view sample, light sample) tried against a triangle
  std::uint64_t exact = 0;      ///< of these, pairs decided by exact predicates
};

/// Computes the light samples that a triangle hides from a view sample: the set B_jk of Eisemann and Décoret 2007. Each
/// bit equals visibility::segment_meets_triangle: double arithmetic where its error bound makes the result certain,
/// else that function. For planar lights and suns.
///
/// The triangle a b c is oriented so that D = det(a − p, b − p, c − p) > 0. Then the segment p→l meets it iff f_i(l) =
/// (l − p) · ((x_i − p) × (x_i+1 − p)) > 0 for its three edges, and l is beyond its plane. All four functions are
/// affine in l: with l = o + w, w from a table, each light sample costs three products and sums.
class BlockedSamples {
 public:
  BlockedSamples() = default;
  explicit BlockedSamples(const visibility::Light& light);

  /// Clears in `visible` (words_per_mask() words, or those from `first_word` on) the light samples that the triangle
  /// hides from p. Bits already cleared are not tested.
  void hide(const glm::vec3& p, const std::array<glm::vec3, 3>& corners, std::span<std::uint32_t> visible,
            PairCounts& counts, std::size_t first_word = 0) const;

 private:
  void decide(const glm::vec3& p, const std::array<glm::vec3, 3>& corners, std::size_t word, std::uint32_t open,
              std::uint32_t& visible, PairCounts& counts) const;

  const visibility::Light* light_ = nullptr;
  std::size_t padded_ = 0;          // number of light samples, padded to whole words
  std::vector<double> directions_;  // w of each light sample: all x, all y, all z
  glm::dvec3 origin_{0};            // o
  glm::dvec3 middle_{0}, half_{0};  // a box around all w
  double farthest_ = 0;             // the largest |w|
};

}  // namespace penumbra::pairs
