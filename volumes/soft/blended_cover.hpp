// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace penumbra::volumes {

/// Occluders' cover of one quarter of the light, which is [0, 1]².
struct Cover {
  double share = 0;
  std::array<double, 4> box{1, 1, 0, 0};  ///< lower x and y, upper x and y; lower > upper: empty

  [[nodiscard]] double box_area() const;
};

/// Adds one occluder: the part of its share that remains if the existing cover were spread evenly over its box. The
/// result is between the larger of the two shares and their sum.
Cover blend(const Cover& there, const Cover& added);

}  // namespace penumbra::volumes
