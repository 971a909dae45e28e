// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// The minimum of some numbers, and the first index at which it occurs.
struct FirstLeast {
  double least = std::numeric_limits<double>::infinity();
  std::size_t at = 0;
};
/// Returns the minimum of all numbers but the last kRoom, which must be infinite: vectors read beyond the others.
FirstLeast first_least(std::span<const double> numbers);
constexpr std::size_t kRoom = 8;

}  // namespace penumbra::volumes
