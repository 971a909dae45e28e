// SPDX-License-Identifier: Apache-2.0
#pragma once

// The maps of a stage's light from its centre, as in the self-test; and view samples set by hand.

#include "selftest/centre_maps.hpp"
#include "tests/analytic/maps/fixture.hpp"

namespace penumbra::tests {

/// View samples set by hand on the plane through `middle` spanned by `u` and `v`: n × n of them, at middle + s u + t v,
/// where s and t are the middles of equal steps from −1 to 1, on triangle 0. `up` is their normal.
inline auto grid_samples(std::uint32_t n, const glm::dvec3& middle, const glm::dvec3& u, const glm::dvec3& v,
                         const glm::dvec3& up) {
  return [=](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = samples.height = n;
    for (std::uint32_t i = 0; i < n * n; ++i) {
      const std::uint32_t column = i % n, row = i / n;
      const double s = (2.0 * column + 1) / n - 1, t = (2.0 * row + 1) / n - 1;
      samples.triangle.push_back(0);
      samples.p.emplace_back(middle + s * u + t * v - floats.origin);
      samples.n.emplace_back(up);
      samples.depth.push_back(1);
      samples.facing.push_back(1);
    }
    return samples;
  };
}

}  // namespace penumbra::tests
