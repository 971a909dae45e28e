// SPDX-License-Identifier: Apache-2.0
// V of masks: counts of bits, or sums of weights.

#include "visibility/masks/visible_share.hpp"

#include "base/assert.hpp"
#include "visibility/dome_faces.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>

namespace penumbra::visibility {

float visible_share(const Light& light, std::span<const std::uint32_t> mask) {
  PENUMBRA_ASSERT(!light.dome, "light {} is a dome, whose samples count with their cosines", light.name);
  if (light.weights.empty()) {
    int visible = 0;
    for (const std::uint32_t word : mask) visible += std::popcount(word);
    return static_cast<float>(visible) / static_cast<float>(light.sample_count());
  }
  double share = 0;  // exact, as explained at sample_weights
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::uint32_t left = mask[i]; left != 0; left &= left - 1) {
      share += light.weights[32 * i + static_cast<std::size_t>(std::countr_zero(left))];
    }
  }
  return static_cast<float>(share);
}

float visible_share(const Light& light, std::span<const std::uint32_t> mask, const glm::vec3& n) {
  return light.dome ? dome_share(light, mask, n) : visible_share(light, mask);
}

namespace {

template <typename Share>
void for_each_mask(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility,
                   const Share& share) {
  const std::size_t words = light.words_per_mask();
  PENUMBRA_ASSERT(visibility.size() * words == masks.size(), "{} values for {} words of {} each", visibility.size(),
                  masks.size(), words);
  constexpr std::size_t kGrain = 1024;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visibility.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      visibility[i] = share(i, masks.subspan(i * words, words));
    }
  });
}

}  // namespace

void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility) {
  for_each_mask(light, masks, visibility,
                [&](std::size_t, std::span<const std::uint32_t> mask) { return visible_share(light, mask); });
}

void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<const glm::vec3> normals,
                    std::span<float> visibility) {
  PENUMBRA_ASSERT(normals.size() == visibility.size(), "{} normals for {} values", normals.size(), visibility.size());
  for_each_mask(light, masks, visibility, [&](std::size_t i, std::span<const std::uint32_t> mask) {
    return visible_share(light, mask, normals[i]);
  });
}

}  // namespace penumbra::visibility
