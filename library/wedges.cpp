// SPDX-License-Identifier: Apache-2.0
// Penumbra wedges of a scene as JSON, with instances copied first; the steps of building them become progress in
// percent.

#include "library/as_error.hpp"
#include "library/library_progress.hpp"
#include "library/scene_state.hpp"
#include "scenes/formats/checks.hpp"
#include "session/wedges/built_wedges.hpp"

#include <penumbra/wedges.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace penumbra {

std::string wedges_json(const Scene& scene, const WedgeOptions& options) {
  const RendererOptions host{.progress = options.progress};
  LibraryProgress progress(host);
  constexpr std::uint64_t kSteps = 100;
  std::uint64_t reached = 0;
  const std::function<void(double)> step = [&](double done) {
    if (reached == 0) progress.begin("wedges", kSteps);
    const auto steps = static_cast<std::uint64_t>(std::lround(done * static_cast<double>(kSteps)));
    if (steps > reached) progress.advance(steps - std::exchange(reached, steps));
  };
  try {
    const scenes::Instances& instances = scene.state().instances;
    std::optional<scenes::Scene> copies;
    if (!instances.empty())
      copies = scenes::copied(scene.state().scene, instances, session::BuiltWedges::kBytesPerTriangle);
    const scenes::Scene& built_of = copies ? *copies : scene.state().scene;
    scenes::check_scene(built_of, "the scene");
    const session::BuiltWedges wedges(built_of,
                                      {options.light, options.construction, options.from, options.validate, &step});
    return session::wedges_json(wedges.result());
  } catch (...) {
    progress.rethrow();
    throw_as_error();
  }
}

}  // namespace penumbra
