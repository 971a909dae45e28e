// SPDX-License-Identifier: Apache-2.0
// Command `sweep`: options and tables.

#include "app/commands.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/run_options.hpp"
#include "app/sweep/sweep.hpp"
#include "app/sweep/sweep_files.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "compare/stats.hpp"
#include "mesh/soup_memory.hpp"
#include "session/comparison/comparison.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/methods.hpp"
#include "session/options.hpp"
#include "session/pictures/frames.hpp"
#include "session/process/output_files.hpp"
#include "session/session.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

namespace penumbra::app {
namespace {

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "-";
}

void print_table(const Sweep& sweep) {
  fmt::print("{:<44} {:>10} {:>10} {:>9}\n", "entry", "rmse", "shadow s", "");
  const std::map<std::string, std::string>* light = nullptr;
  for (const SweepRow& row : sweep.rows) {
    if ((light == nullptr || *light != row.light) && !row.light.empty()) {
      for (const auto& [key, value] : row.light) fmt::print("{}={}\n", key, value);
    }
    light = &row.light;
    const auto& error = row.result.all_lights_error;
    fmt::print("{:<44} {:>10} {:>10} {:>9}\n", row.result.entry, error ? fmt::format("{:.6f}", error->rmse) : "-",
               cell(row.result.stats.seconds.shadow()),
               row.result.failure ? "failed"
               : row.on_hull      ? "on hull"
                                  : "");
  }
}

class SweepCommand : public Command {
 public:
  explicit SweepCommand(CLI::App& app)
      : Command(app, "sweep",
                "measure error against time of methods over ranges of their options and of the light's size") {
    add_run_options(cli_, run_);
    cli_.add_option("-o,--output", run_.out, "folder for sweep.csv, sweep.json and sweep.svg")
        ->required()
        ->type_name("DIR");
    cli_.add_option("--methods,--method", methods_,
                    "what to compare: names with options of their own, a:key=value,b; or geometry, image, all, default")
        ->type_name("LIST")
        ->capture_default_str();
    cli_.add_option(
            "--over", over_,
            "what to vary: options of the methods, light-samples, and the lights' size (light.half in the scene's "
            "unit, light.angle of suns in degrees), such as size=256..4096 (doubled), layers=1,2,4, "
            "light.half=0.1..0.5+0.1; methods take the keys that they have; may be given again")
        ->required()
        ->allow_extra_args(false)
        ->type_name("KEY=VALUES,…");
    cli_.add_option(
            "--reference", reference_,
            fmt::format("reference of the errors, as in `compare` (default: {} if it supports the lights, else rays)",
                        session::exact_area_example()))
        ->type_name("NAME");
    cli_.add_option("--reference-samples", options_.reference_samples, "light samples of the reference, if rays")
        ->type_name("M")
        ->capture_default_str();
    cli_.add_option("--runs", options_.runs,
                    "timed runs of each entry, after a discarded one; their median counts (default: as many as fit "
                    "into two seconds, one to five)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
    cli_.add_option("--frame", frame_, "frame of the scene's animation, or a moment between two, such as 12.5")
        ->type_name("F");
    cli_.add_option("--fps", fps_, "frame F is F / fps seconds of a glTF animation (default: 24)")->type_name("N");
  }

  int run(const GlobalOptions& global) override {
    options_.methods = session::parse_methods(methods_);
    options_.method_options = session::parse_method_options(run_.method_options);
    const std::vector<SweptKey> over = parse_over(over_);
    if (options_.reference_samples == "same")
      throw UsageError("--reference-samples same: a sweep has one reference for all rows; expected a number");
    std::optional<double> time;
    if (frame_) time = session::parse_frame(*frame_) * (1 / session::parse_fps(fps_));
    session::OutputFolder folder;
    session::OutputFiles outputs;
    folder.make(run_.out);
    const auto csv = run_.out / "sweep.csv", json = run_.out / "sweep.json", svg = run_.out / "sweep.svg";
    for (const auto& file : {csv, json, svg}) outputs.add("-o", file);
    outputs.refuse_inputs({&run_.scene, 1});
    outputs.require_writable();
    TerminalProgress progress(!global.quiet);
    // Each comparison has a copy of the scene.
    const scenes::Scene scene = session::read_session_scene(
        run_, time, {.bytes_per_copy = mesh::soup_bytes(1, 1) + session::bytes_per_copy(options_)});
    outputs.refuse_inputs(scene.sources);
    options_.reference = reference_.empty() ? best_reference(scene) : reference_;
    const Sweep sweep = sweep_methods(scene, run_, options_, over, progress);
    progress.clear();
    write_file_atomically(json, compare::json_text(sweep_json(sweep)));
    write_file_atomically(csv, sweep_csv(sweep));
    write_file_atomically(svg, sweep_svg(sweep));
    print_table(sweep);
    for (const SweepRow& row : sweep.rows) {
      if (row.result.failure) return row.result.failure->exit_code;  // its message has already been printed
    }
    return 0;
  }

 private:
  /// Returns exact areas if the first method that computes them by options supports all lights, else rays.
  [[nodiscard]] std::string best_reference(const scenes::Scene& scene) const {
    const std::string areas = session::exact_area_example();
    const visibility::MethodDescription method = session::describe_reference(areas).description;
    std::vector<visibility::Light> lights;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
      const bool is_chosen =
          run_.lights.empty() || std::ranges::find(run_.lights, scene.lights[i].name) != run_.lights.end();
      if (!is_chosen) continue;
      for (visibility::Light& light : visibility::make_light_pieces(scene, i, scene.origin.value_or(glm::dvec3(0)), {}))
        lights.push_back(std::move(light));
    }
    return session::can_do(method, lights) ? areas : session::ray_judge().name;
  }

  session::RunOptions run_;
  session::ComparisonOptions options_;
  std::string methods_ = "default", reference_, fps_;
  std::vector<std::string> over_;
  std::optional<std::string> frame_;
};

}  // namespace

std::unique_ptr<Command> make_sweep_command(CLI::App& app) {
  return std::make_unique<SweepCommand>(app);
}

}  // namespace penumbra::app
