// SPDX-License-Identifier: Apache-2.0
// Computes visible errors of V: differences of more than one step of 255, and banding between neighbouring pixels
// (eye.hpp).

#include "compare/eye.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::compare {

std::optional<EyeError> eye_error(const JudgedVisibility& light, std::span<const std::uint32_t> penumbra,
                                  std::uint32_t width) {
  if (light.pixels.empty()) return std::nullopt;
  const auto error = [&](std::uint32_t pixel) {
    return static_cast<double>(light.visibility[pixel]) - static_cast<double>(light.reference[pixel]);
  };
  EyeError eye;
  const auto shown =
      std::ranges::count_if(light.pixels, [&](std::uint32_t pixel) { return std::abs(error(pixel)) > kShown; });
  eye.over255 = static_cast<double>(shown) / static_cast<double>(light.pixels.size());
  double squares = 0;
  std::uint64_t pairs = 0;
  for (const std::uint32_t pixel : penumbra) {
    const auto with = [&](std::uint32_t neighbour) {
      if (!std::ranges::binary_search(penumbra, neighbour)) return;
      const double step = error(pixel) - error(neighbour);
      squares += step * step;
      ++pairs;
    };
    if ((pixel + 1) % width != 0) with(pixel + 1);
    with(pixel + width);
  }
  if (pairs != 0) eye.banding = std::sqrt(squares / static_cast<double>(pairs));
  return eye;
}

}  // namespace penumbra::compare
