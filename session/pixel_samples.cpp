// SPDX-License-Identifier: Apache-2.0
// Finds the view samples of single pixels by testing every triangle.

#include "session/pixel_samples.hpp"

#include "base/assert.hpp"

#include <tbb/parallel_for.h>

#include <utility>
#include <vector>

namespace penumbra::session {

using visibility::SceneFloats;
using visibility::ViewSamples;

ViewSamples samples_at(const SceneFloats& scene, const visibility::PinholeCamera& camera,
                       std::span<const std::uint32_t> pixels) {
  std::vector<std::int32_t> carriers(std::size_t{camera.width} * camera.height, ViewSamples::kBackground);
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    PENUMBRA_ASSERT(pixels[i] < carriers.size(), "pixel {} of {}", pixels[i], carriers.size());
    carriers[pixels[i]] = visibility::carrier_of(scene, camera, pixels[i] % camera.width, pixels[i] / camera.width);
  });
  return visibility::complete_view_samples(scene, camera, std::move(carriers));
}

}  // namespace penumbra::session
