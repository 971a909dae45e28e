// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace penumbra::volumes {

/// A variant of `depth-complexity` that stores its counters in addition to its masks, for inspection. The base is
/// virtual because a variant may inherit Method through another class, too.
class DepthCounters : public virtual visibility::Method {
 public:
  /// Counter of light samples left to exact predicates, and of all light samples if p sees nothing of the light.
  static constexpr std::int32_t kNoCounter = std::numeric_limits<std::int32_t>::min();

  /// Reads one counter for each light sample and each pixel of the tile evaluated last. Light samples below the horizon
  /// have a counter, too.
  virtual void read_counters(std::span<std::int32_t> counters) = 0;
};
/// Makes variant=soup.
std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device);

}  // namespace penumbra::volumes
