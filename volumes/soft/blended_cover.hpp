#pragma once

#include <array>

namespace penumbra::volumes {

/// What occluders cover of one quarter of the light, which is [0, 1]².
struct Cover {
  double share = 0;
  std::array<double, 4> box{1, 1, 0, 0};  ///< lower x and y, upper x and y; lower > upper: nothing

  [[nodiscard]] double box_area() const;
};

/// Adds one occluder: of its share as much as if what was there were spread evenly over its box. Between the larger of
/// the two shares and their sum.
Cover blend(const Cover& there, const Cover& added);

}  // namespace penumbra::volumes
