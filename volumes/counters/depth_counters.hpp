#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace penumbra::volumes {

/// A variant of `depth-complexity` that keeps its counters beside its masks: to look at them.
/// Virtual: a variant may be a method by another way, too.
class DepthCounters : public virtual visibility::Method {
 public:
  /// Left to exact predicates, or of a view sample that sees nothing of the light.
  static constexpr std::int32_t kNoCounter = std::numeric_limits<std::int32_t>::min();

  /// For each pixel of the tile last evaluated, one counter a light sample. Light samples below the horizon have one.
  virtual void read_counters(std::span<std::int32_t> counters) = 0;
};
/// variant=soup.
std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device);

}  // namespace penumbra::volumes
