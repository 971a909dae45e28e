#pragma once

#include <cstddef>
#include <limits>
#include <span>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// The least of some numbers, and the first of those that are it.
struct FirstLeast {
  double least = std::numeric_limits<double>::infinity();
  std::size_t at = 0;
};
/// Of all but the last kRoom, which must be infinite: vectors read beyond the others.
FirstLeast first_least(std::span<const double> numbers);
constexpr std::size_t kRoom = 8;

}  // namespace penumbra::volumes
