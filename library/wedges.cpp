// SPDX-License-Identifier: Apache-2.0
#include "app/wedges/built_wedges.hpp"
#include "library/as_error.hpp"
#include "library/scene_state.hpp"
#include "scenes/formats/checks.hpp"

#include <penumbra/wedges.hpp>

#include <optional>

namespace penumbra {

std::string wedges_json(const Scene& scene, const WedgeOptions& options) {
  return with_errors([&] {
    const scenes::Instances& instances = scene.state().instances;
    std::optional<scenes::Scene> copies;
    if (!instances.empty()) copies = scenes::copied(scene.state().scene, instances);
    const scenes::Scene& built_of = copies ? *copies : scene.state().scene;
    scenes::check_scene(built_of, "the scene");
    const app::BuiltWedges wedges(built_of, {options.light, options.construction, options.from, options.validate});
    return app::wedges_json(wedges.result());
  });
}

}  // namespace penumbra
