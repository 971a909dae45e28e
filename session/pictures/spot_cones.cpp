// SPDX-License-Identifier: Apache-2.0
// Marks the view samples outside a spot lamp's cone, where its light is 0 whatever V is.

#include "session/pictures/spot_cones.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra::session {

std::vector<std::vector<std::uint8_t>> samples_beside_cones(const visibility::ViewSamples& samples,
                                                            std::span<const visibility::Light> lights,
                                                            std::span<const std::string> named) {
  using visibility::ViewSamples;
  std::vector<std::vector<std::uint8_t>> beside;
  for (std::size_t light = 0; light < lights.size(); ++light) {
    if (!lights[light].spot || std::ranges::find(named, lights[light].name) == named.end()) continue;
    beside.resize(lights.size());
    beside[light].resize(samples.size());
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
      // The normal only weighs the arriving light.
      const bool is_dark = samples.triangle[i] != ViewSamples::kBackground &&
                           visibility::spot_share(lights[light], samples.p[i], glm::vec3(0)) == 0;
      beside[light][i] = is_dark ? 1 : 0;
    });
  }
  return beside;
}

}  // namespace penumbra::session
