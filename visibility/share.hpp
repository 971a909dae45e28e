// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::visibility {

/// Shares of a light are sums and quotients of floats, which Vulkan lets be off by 2.5 units in the last place (a
/// quotient of equal numbers need not be 1): this is room for two of them, and far below the error of any method.
inline constexpr float kRoundedShare = 0x1p-20F;

/// Returns whether `visibility` is a share of a light: from 0 to 1, or outside by rounding alone. False for NaN.
inline bool is_share(float visibility) {
  return visibility >= -kRoundedShare && visibility <= 1 + kRoundedShare;
}

}  // namespace penumbra::visibility
