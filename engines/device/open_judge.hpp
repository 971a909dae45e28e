// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/device/mask.shared.h"
#include "engines/device/mask_layout.hpp"
#include "visibility/tree/pair_judge.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::device {

/// Light samples that a kernel left open: bits of one word of a view sample's mask.
struct OpenBits {
  std::uint32_t pixel = 0;                  ///< pixel of the tile; | gpu::kWholePixel: its mask is undefined so far
  std::uint32_t word = 0;                   ///< index of the word in the pixel's mask
  std::uint32_t bits = 0;                   ///< bits without a light sample are never set
  std::uint32_t hider = gpu::kAnyTriangle;  ///< kAnyTriangle, gpu::kCarrier, or a triangle: decides whether that one
                                            ///< hides the light samples
};

struct JudgeInput {
  visibility::PairJudge pairs;
  const MaskLayout& layout;
  std::size_t first_pixel;  ///< index of the tile's first pixel in the view samples
};

/// Returns decisions by exact predicates (visibility/pair_truth.hpp), in the order of the questions, on all cores. For
/// a question about one hider only the light samples hidden by it are decided; questions that decide nothing give no
/// word.
std::vector<gpu::MaskWord> decide(const JudgeInput& input, std::span<const OpenBits> questions);

}  // namespace penumbra::device
