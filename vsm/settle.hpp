#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "vsm/view_sample.shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vsm {

/// Bits to set in one word of a tile's masks (blocked light samples).
struct Answer {
  std::uint32_t word = 0, bits = 0;
};

struct SettleInput {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& tree;
  const visibility::ViewSamples& samples;
  const visibility::Light& light;
  std::size_t first_pixel = 0;            ///< of the tile
  std::span<const std::uint32_t> bit_of;  ///< for each of the device's sample numbers, the light sample
};

/// Answers by exact predicates what float arithmetic left open. Parallel; the result does not depend on the order of
/// the questions but as a set.
std::vector<Answer> settle(const SettleInput& input, std::span<const gpu::OpenQuestion> questions);

}  // namespace penumbra::vsm
