// SPDX-License-Identifier: Apache-2.0
// Translates the library's options of a comparison into those of the command `compare`, and runs it.

#include "compare/stats.hpp"
#include "library/as_error.hpp"
#include "library/library_progress.hpp"
#include "library/scene_state.hpp"
#include "scenes/formats/checks.hpp"
#include "session/comparison/comparison.hpp"
#include "session/options.hpp"

#include <penumbra/compare.hpp>

#include <fmt/ranges.h>

namespace penumbra {

std::string compare_json(const Scene& scene, const CompareOptions& options, const RendererOptions& renderer) {
  const Scene::State& state = scene.state();
  scenes::check_scene(state.scene, "the scene", true, state.instances);
  session::RunOptions run;
  run.scene = "the scene";
  run.out = options.out;
  run.device = renderer.device;
  run.light_samples = fmt::format("{}", options.light_samples);
  run.sample_pattern = options.sample_pattern;
  run.lights = options.lights;
  run.camera = options.camera;
  if (run.camera.empty() && state.camera) run.camera = state.scene.cameras[*state.camera].name;
  if (options.width != 0 || options.height != 0) run.size = fmt::format("{}x{}", options.width, options.height);
  session::ComparisonOptions comparison;
  comparison.methods = session::parse_methods(fmt::format("{}", fmt::join(options.methods, ",")));
  comparison.reference = options.reference;
  comparison.reference_samples = options.reference_samples;
  if (options.runs != 0) comparison.runs = options.runs;
  comparison.error_budget = options.error_budget;
  comparison.writes = !options.out.empty();
  comparison.reports_often = static_cast<bool>(renderer.progress);
  LibraryProgress progress(renderer);
  const compare::Metrics metrics = [&] {
    try {
      return session::compare_methods(scenes::copied(state.scene, state.instances, session::bytes_per_copy(comparison)),
                                      run, comparison, progress);
    } catch (...) {
      progress.rethrow();
      throw_as_error();
    }
  }();
  progress.rethrow();
  return compare::json_text(compare::to_json(metrics));
}

}  // namespace penumbra
