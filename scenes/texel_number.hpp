// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace penumbra::scenes {

/// Returns the index of a texel along one side of a picture with `size` texels, for any integral distance `texel` from
/// the first one.
inline std::size_t texel_number(double texel, std::uint32_t size, PictureUse::Wrap wrap) {
  const double count = size;
  if (wrap == PictureUse::Wrap::clamp) return static_cast<std::size_t>(std::clamp(texel, 0.0, count - 1));
  const double period = wrap == PictureUse::Wrap::mirror ? 2 * count : count;
  double at = texel - period * std::floor(texel / period);
  if (at >= count) at = period - 1 - at;  // mirrored
  return static_cast<std::size_t>(std::clamp(at, 0.0, count - 1));
}

}  // namespace penumbra::scenes
