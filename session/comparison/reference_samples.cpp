// SPDX-License-Identifier: Apache-2.0
// Light samples of a reference that uses them: the methods' own, or a different number in the same pattern.

#include "session/comparison/reference_samples.hpp"

#include "base/error.hpp"
#include "session/whole_lights.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace penumbra::session {

visibility::SampleRequest reference_samples(const RunOptions& run, const std::string& wanted) {
  const visibility::SampleRequest own = parse_light_samples(run);  // errors name the methods' options
  if (wanted == "same") return own;
  RunOptions reference = run;
  reference.light_samples = wanted;
  try {
    return parse_light_samples(reference);
  } catch (const UsageError&) {
    throw UsageError("--reference-samples {}: expected a number of light samples from 1 to 4096, or same", wanted);
  }
}

std::vector<visibility::Light> with_samples(const Session& session, const visibility::SampleRequest& request) {
  std::vector<visibility::Light> lights;
  for (const WholeLight& whole : whole_lights(session.lights)) {
    const auto index = static_cast<std::uint32_t>(session.lights[whole.first].index);
    std::ranges::move(visibility::make_light_pieces(session.scene, index, session.floats.origin, request),
                      std::back_inserter(lights));
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].filtered_by = session.lights[i].filtered_by;
    lights[i].dimmed_by = session.lights[i].dimmed_by;
  }
  return lights;
}

}  // namespace penumbra::session
