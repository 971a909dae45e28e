// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/plain_rays.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::bench {

/// Ray caster like that of a renderer which makes use of the fact that most of a picture is completely lit or dark: it
/// uses a few light samples everywhere, and all of them only where the results of the few differ.
class AdaptiveRays {
 public:
  static constexpr std::uint32_t kFew = 64;  ///< light samples of the first step

  /// `few`: the light with kFew light samples.
  explicit AdaptiveRays(visibility::Light few) : few_(std::move(few)) {}

  struct Seconds {
    double light = 0, evaluate = 0;
  };
  /// Computes V of each pixel. `samples` are unchanged on return.
  Seconds run(reference::PlainRays& rays, visibility::ViewSamples& samples, const visibility::Light& light,
              std::span<float> visibility);
  /// Returns the number of view samples that got all light samples in the last run.
  [[nodiscard]] std::uint64_t asked() const { return asked_; }

 private:
  visibility::Light few_;
  std::vector<std::int32_t> undecided_;  // the samples' triangles; background for all decided samples
  std::vector<float> all_samples_;
  std::uint64_t asked_ = 0;
};

}  // namespace penumbra::bench
