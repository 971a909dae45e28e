// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::visibility {

/// Tolerance for shares of a light, which are sums and quotients of floats. Vulkan permits an error of 2.5 units in the
/// last place in a quotient (equal numbers need not give 1). This allows for two of them, and is far below the error of
/// any method.
inline constexpr float kRoundedShare = 0x1p-20F;

/// Returns whether `visibility` is a share of a light: from 0 to 1, or outside by rounding alone. False for NaN.
inline bool is_share(float visibility) {
  return visibility >= -kRoundedShare && visibility <= 1 + kRoundedShare;
}

}  // namespace penumbra::visibility
