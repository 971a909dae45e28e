// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// Condition (1) for many light points at once: above_horizon() of pair_truth, computed in double arithmetic where its
/// rounding error cannot change the sign, and exactly elsewhere. `bounds` must contain all points tested, such as
/// point_bounds. The light must outlive this object.
class HorizonTest {
 public:
  HorizonTest(const Light& light, const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const Bounds& bounds);

  [[nodiscard]] bool all_above() const { return lowest_ > error_; }
  [[nodiscard]] bool none_above() const { return highest_ < -error_; }
  [[nodiscard]] bool above(const glm::vec3& l) const;

  /// Sets bit j of `words` iff points[j] is above the horizon; clears the other bits.
  void mask(std::span<const glm::vec3> points, std::span<std::uint32_t> words) const;

 private:
  const Light* light_;
  std::array<glm::vec3, 3> carrier_;
  glm::dvec3 a_, normal_;  ///< a point of the plane, 0 for directions; its normal
  double error_ = 0;       ///< bounds the rounding error of every height between lower and upper
  double lowest_ = 0, highest_ = 0;
  std::int8_t facing_;
};

}  // namespace penumbra::visibility
