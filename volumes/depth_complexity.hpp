#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace penumbra::volumes {

/// `depth-complexity`: an integer counter a light sample says how many triangles are before it. Any planar light, one-
/// and two-sided, any pattern of light samples. docs/depth-complexity.md.
///
/// variant=soup (default; ours): signed multiplicities and a certified reference; any triangle soup, every bit the
/// truth of its pair. variant=laine (Laine et al. 2005): silhouettes count ±1 and one reference ray a view sample gives
/// the constant; right for closed meshes, wrong where an open one folds over.
std::unique_ptr<visibility::Method> make_depth_complexity(const render::Device& device,
                                                          const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription depth_complexity_description();

/// variant=soup that keeps its counters beside its masks, four bytes a pair: to look at them.
class DepthCounters : public visibility::Method {
 public:
  /// Left to exact predicates, or of a view sample that sees nothing of the light.
  static constexpr std::int32_t kNoCounter = std::numeric_limits<std::int32_t>::min();

  /// For each pixel of the tile last evaluated, one counter a light sample. Light samples below the horizon have one.
  virtual void read_counters(std::span<std::int32_t> counters) = 0;
};
std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device);

}  // namespace penumbra::volumes
