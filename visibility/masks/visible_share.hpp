#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// V of a mask (words_per_mask() words; bits beyond the last sample are 0): the share of its bits that are set, or of a
/// light with a texture the sum of their weights.
float visible_share(const Light& light, std::span<const std::uint32_t> mask);

/// Of a dome, too, whose light samples count with their cosines to the view sample's normal.
float visible_share(const Light& light, std::span<const std::uint32_t> mask, const glm::vec3& n);

/// V of many masks that lie one after the other, of any light but a dome. The number of threads changes nothing.
void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility);
/// Of any light: with the normals of the view samples.
void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<const glm::vec3> normals,
                    std::span<float> visibility);

}  // namespace penumbra::visibility
