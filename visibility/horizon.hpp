#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// Condition (1) for many light points at once: above_horizon() of pair_truth, answered in plain double arithmetic
/// wherever its rounding error cannot reach zero, and exactly elsewhere. `lower` and `upper` bound all points asked
/// for.
class HorizonTest {
 public:
  HorizonTest(const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const glm::vec3& lower,
              const glm::vec3& upper);

  [[nodiscard]] bool all_above() const { return lowest_ > error_; }
  [[nodiscard]] bool none_above() const { return highest_ < -error_; }
  [[nodiscard]] bool above(const glm::vec3& l) const;

  /// Sets bit j of `words` iff points[j] is above; the other bits are cleared.
  void mask(std::span<const glm::vec3> points, std::span<std::uint32_t> words) const;

 private:
  std::array<glm::vec3, 3> carrier_;
  glm::dvec3 a_, normal_;
  double error_ = 0;  ///< bounds the rounding error of every height between lower and upper
  double lowest_ = 0, highest_ = 0;
  std::int8_t facing_;
};

}  // namespace penumbra::visibility
