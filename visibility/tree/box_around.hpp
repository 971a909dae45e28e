// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>

/// Inside visibility/tree/ only.
namespace penumbra::visibility {

/// Bounds of boxes: empty, or just containing all included boxes. The fourth float of a corner is unused, so that a
/// vector unit handles a corner at once.
class BoxAround {
 public:
  using Corner = float __attribute__((vector_size(16)));  // a vector extension of GCC and clang

  /// `Box`: a lower and an upper corner, each followed by a word (NumberedBox, BoxGroup).
  template <typename Box>
  void include(const Box& box) {
    static_assert(sizeof(Box) == 2 * sizeof(Corner) && offsetof(Box, lower) == 0);
    std::array<Corner, 2> corners;
    std::memcpy(&corners, &box, sizeof corners);
    include(corners[0], corners[1]);
  }
  void include(const BoxAround& box) { include(box.lower_, box.upper_); }
  void include(const glm::vec3& point) {
    const Corner at{point.x, point.y, point.z, 0};
    include(at, at);
  }

  [[nodiscard]] glm::vec3 lower() const { return {lower_[0], lower_[1], lower_[2]}; }
  [[nodiscard]] glm::vec3 upper() const { return {upper_[0], upper_[1], upper_[2]}; }
  /// Returns half of its surface area; 0 if it is empty. In double: no product of floats overflows.
  [[nodiscard]] double area() const {
    if (lower_[0] > upper_[0]) return 0;
    const glm::dvec3 size = glm::dvec3(upper()) - glm::dvec3(lower());
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }

 private:
  static constexpr float kFar = std::numeric_limits<float>::infinity();

  void include(Corner lower, Corner upper) {
    lower_ = lower < lower_ ? lower : lower_;
    upper_ = upper_ < upper ? upper : upper_;
  }

  Corner lower_{kFar, kFar, kFar, kFar}, upper_{-kFar, -kFar, -kFar, -kFar};
};

}  // namespace penumbra::visibility
