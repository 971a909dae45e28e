// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace penumbra::volumes {

/// The cover of one quarter of the light, [0, 1]², by occluders.
struct Cover {
  double share = 0;
  std::array<double, 4> box{1, 1, 0, 0};  ///< lower x and y, upper x and y; lower > upper: empty

  [[nodiscard]] double box_area() const;
};

/// Adds one occluder. Only a part of its share is added: what remains visible of it if the existing cover is spread
/// evenly over its box. The result is between the larger of the two shares and their sum.
Cover blend(const Cover& there, const Cover& added);

}  // namespace penumbra::volumes
