// SPDX-License-Identifier: Apache-2.0
// Casts a few rays everywhere, and all rays where the results of the few differ.

#include "bench/adaptive_rays.hpp"

#include "session/process/stopwatch.hpp"

#include <utility>

namespace penumbra::bench {

AdaptiveRays::Seconds AdaptiveRays::run(reference::PlainRays& rays, visibility::ViewSamples& samples,
                                        const visibility::Light& light, std::span<float> visibility) {
  Seconds seconds;
  session::Stopwatch watch;
  rays.prepare_light(few_);
  seconds.light = watch.seconds();
  watch.restart();
  rays.evaluate(samples, visibility);
  undecided_.resize(samples.size());
  asked_ = 0;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    const bool undecided = visibility[i] > 0 && visibility[i] < 1;
    undecided_[i] = undecided ? samples.triangle[i] : visibility::ViewSamples::kBackground;
    asked_ += undecided ? 1 : 0;
  }
  seconds.evaluate = watch.seconds();
  watch.restart();
  rays.prepare_light(light);
  seconds.light += watch.seconds();
  watch.restart();
  all_samples_.resize(samples.size());
  std::swap(undecided_, samples.triangle);
  rays.evaluate(samples, all_samples_);
  std::swap(undecided_, samples.triangle);
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if (undecided_[i] != visibility::ViewSamples::kBackground) visibility[i] = all_samples_[i];
  }
  seconds.evaluate += watch.seconds();
  return seconds;
}

}  // namespace penumbra::bench
