// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace penumbra::volumes {

/// A variant of `depth-complexity` that stores its counters in addition to its masks, for inspection. Virtual base: a
/// variant may also derive from a method otherwise.
class DepthCounters : public virtual visibility::Method {
 public:
  /// Value for light samples left to exact predicates, or of a view sample that sees nothing of the light.
  static constexpr std::int32_t kNoCounter = std::numeric_limits<std::int32_t>::min();

  /// Reads one counter for each light sample and each pixel of the tile evaluated last. Light samples below the horizon
  /// have a counter, too.
  virtual void read_counters(std::span<std::int32_t> counters) = 0;
};
/// Makes variant=soup.
std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device);

}  // namespace penumbra::volumes
