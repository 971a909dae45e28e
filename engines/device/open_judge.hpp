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
  std::uint32_t pixel = 0;                  ///< of the tile; | gpu::kWholePixel: its mask says nothing yet
  std::uint32_t word = 0;                   ///< of the pixel's mask
  std::uint32_t bits = 0;                   ///< some may be no light sample: they stay unset
  std::uint32_t hider = gpu::kAnyTriangle;  ///< or gpu::kCarrier, or a triangle: is it that which hides them?
};

struct JudgeInput {
  visibility::PairJudge pairs;
  const MaskLayout& layout;
  std::size_t first_pixel;  ///< of the tile, in the view samples
};

/// What exact predicates (visibility/pair_truth.hpp) say, in the order of the questions, on all cores. Of a question
/// about one hider only what that hides is decided; no word comes of what decides nothing.
std::vector<gpu::MaskWord> decide(const JudgeInput& input, std::span<const OpenBits> questions);

}  // namespace penumbra::device
