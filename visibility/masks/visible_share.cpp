#include "visibility/masks/visible_share.hpp"

#include "base/assert.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>

namespace penumbra::visibility {

float visible_share(const Light& light, std::span<const std::uint32_t> mask) {
  if (light.weights.empty()) {
    int visible = 0;
    for (const std::uint32_t word : mask) visible += std::popcount(word);
    return static_cast<float>(visible) / static_cast<float>(light.sample_count());
  }
  double share = 0;  // exact: sample_weights says why
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::uint32_t left = mask[i]; left != 0; left &= left - 1) {
      share += light.weights[32 * i + static_cast<std::size_t>(std::countr_zero(left))];
    }
  }
  return static_cast<float>(share);
}

void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility) {
  const std::size_t words = light.words_per_mask();
  PENUMBRA_ASSERT(visibility.size() * words == masks.size(), "{} values for {} words of {} each", visibility.size(),
                  masks.size(), words);
  constexpr std::size_t kGrain = 1024;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visibility.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      visibility[i] = visible_share(light, masks.subspan(i * words, words));
    }
  });
}

}  // namespace penumbra::visibility
