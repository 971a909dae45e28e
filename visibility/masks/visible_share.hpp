// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// Returns V of a mask (words_per_mask() words; bits beyond the last sample are 0): the fraction of its set bits, or
/// for a light with a texture the sum of their weights.
float visible_share(const Light& light, std::span<const std::uint32_t> mask);

/// Returns V for any light, including a dome, whose light samples count with their cosines to the view sample's normal.
float visible_share(const Light& light, std::span<const std::uint32_t> mask, const glm::vec3& n);

/// Computes V of many consecutive masks, of any light but a dome. The result does not depend on the number of threads.
void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility);
/// Computes V for any light, with the normals of the view samples.
void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<const glm::vec3> normals,
                    std::span<float> visibility);

}  // namespace penumbra::visibility
