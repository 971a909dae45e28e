// SPDX-License-Identifier: Apache-2.0
// Shades a picture with the reference's V times the unshadowed light, V · ∫G (docs/error-budget.md, Beauty): the error
// that a method of scalar V makes even with the right V.

#include "session/comparison/separated_beauty.hpp"

#include "session/output.hpp"

#include <algorithm>

namespace penumbra::session {

std::vector<glm::vec3> separated_beauty(const Session& session, std::span<const LightTruth> truths) {
  if (std::ranges::any_of(whole_lights(session.lights), [](const WholeLight& whole) { return whole.count > 1; }))
    return {};
  BeautyAccumulator beauty(session, session.lights);
  for (std::size_t light = 0; light < truths.size(); ++light) {
    TileResult whole;
    whole.light = light;
    whole.tile = {0, session.height};
    whole.visibility = truths[light].reference;
    beauty.add(whole);
  }
  return beauty.sum();
}

}  // namespace penumbra::session
