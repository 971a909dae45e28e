// SPDX-License-Identifier: Apache-2.0
// Command `compare`: options, tables and exit codes.

#include "app/commands.hpp"
#include "app/compare/sequence.hpp"
#include "app/picture_options.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/reading_options.hpp"
#include "app/run_options.hpp"
#include "base/error.hpp"
#include "session/comparison/comparison.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/methods.hpp"
#include "session/options.hpp"
#include "session/parse.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/frames.hpp"
#include "session/pictures/tev_pictures.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace penumbra::app {
namespace {

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// Prints the result as a table on stdout: one line for each method, and one for its errors at horizon pixels, which
/// are not part of the first line.
void print_table(const compare::Metrics& metrics) {
  fmt::print("{} judged pixels, {} at the horizon; errors of V against {}{}\n", metrics.judged_pixels,
             metrics.horizon_pixels, metrics.reference.method,
             metrics.reference.light_samples == 0
                 ? ""
                 : fmt::format(" with {} light samples", metrics.reference.light_samples));
  fmt::print("{:<28} {:>9} {:>9} {:>9} {:>10} {:>12} {:>9}\n", "method", "rmse", "max", "bias", "differing", "of pairs",
             "shadow s");
  const auto line = [](const std::string& name, const compare::Stats& stats, const compare::MethodResult* result) {
    std::string rmse = "-", max = "-", bias = "-", differing = "-", pairs = "-";
    if (result != nullptr && result->failure) rmse = "failed";
    if (result != nullptr && result->error) {
      rmse = fmt::format("{:.6f}", result->error->rmse);
      max = fmt::format("{:.5f}", result->error->max);
      bias = fmt::format("{:+.5f}", result->error->bias);
    }
    if (result != nullptr && result->pairs) {
      differing = fmt::format("{}", result->pairs->differing);
      pairs = fmt::format("{}", result->pairs->all);
    }
    fmt::print("{:<28} {:>9} {:>9} {:>9} {:>10} {:>12} {:>9}\n", name, rmse, max, bias, differing, pairs,
               number(stats.seconds.shadow(), "{:.3f}"));
  };
  for (const compare::MethodResult& result : metrics.methods) {
    line(result.entry, result.stats, &result);
    if (const auto& error = result.horizon_error) {
      fmt::print("{:<28} {:>9.6f} {:>9.5f} {:>+9.5f}\n", "  at the horizon", error->rmse, error->max, error->bias);
    }
  }
  line("reference " + metrics.reference.method, metrics.reference, nullptr);
  if (std::ranges::none_of(metrics.methods, [](const auto& result) { return result.flicker.has_value(); })) return;
  fmt::print("\n{:<28} {:>9}\n", "from frame to frame", "flicker");
  for (const compare::MethodResult& result : metrics.methods)
    fmt::print("{:<28} {:>9}\n", result.entry, number(result.flicker, "{:.6f}"));
}

/// Prints the change of each method's RMSE by the repair of one cause alone, and the remaining error without all
/// causes.
void print_budgets(const compare::Metrics& metrics) {
  std::size_t lights = 0;
  for (const compare::MethodResult& result : metrics.methods) lights = std::max(lights, result.lights.size());
  for (std::size_t light = 0; light < lights; ++light) {
    bool first = true;
    for (const compare::MethodResult& result : metrics.methods) {
      if (light >= result.lights.size() || !result.lights[light].error_budget) continue;
      const compare::ErrorBudget& budget = *result.lights[light].error_budget;
      if (first) {
        if (lights > 1) fmt::print("\nLight {}:", result.lights[light].name);
        fmt::print("\n{:<28} {:>9}", "RMSE, and its change without", "rmse");
        for (const compare::BudgetPart& part : budget.parts) fmt::print(" {:>10}", name_of(part.cause));
        fmt::print(" {:>10}\n", "remainder");
        first = false;
      }
      fmt::print("{:<28} {:>9.6f}", result.entry, budget.rmse);
      for (const compare::BudgetPart& part : budget.parts)
        fmt::print(" {:>10}", number(budget.change(part), "{:+.6f}"));
      fmt::print(" {:>10}\n", number(budget.together.rmse, "{:.6f}"));
    }
  }
}

/// Returns the arguments of `view` that show the compared scene. `given`: the command line of `compare`; the options
/// that both commands have are passed on.
std::vector<std::string> view_arguments(const CLI::App& given, const std::filesystem::path& scene) {
  CLI::App view;
  session::RunOptions shared;
  for (const char* name : {"--size", "--camera", "--device"}) view.add_option(name);
  add_allow_outside(view, shared.allow_outside);
  add_lenient(view, shared.lenient);
  add_gltf_options(view, shared.gltf);
  add_studio_options(view, shared.studio);
  std::vector<std::string> arguments = {"view", scene.string()};
  for (const CLI::Option* option : view.get_options()) {
    const CLI::Option* const asked = given.get_option_no_throw(option->get_name());
    if (asked == nullptr || asked->count() == 0) continue;
    if (option->get_expected_max() == 0) {  // a flag
      arguments.push_back(option->get_name());
      continue;
    }
    for (const std::string& value : asked->results()) arguments.insert(arguments.end(), {option->get_name(), value});
  }
  return arguments;
}

class CompareCommand : public Command {
 public:
  /// Limit of the first run of a method that is not requested by name, so that a comparison ends within minutes.
  static constexpr double kMostGroupSeconds = 30;

  explicit CompareCommand(CLI::App& app)
      : Command(app, "compare", "compare methods with a reference on the same view samples") {
    add_run_options(cli_, run_);
    cli_.add_option("-o,--output", run_.out,
                    "folder for metrics.json, metrics.csv, report.html, and each method's pictures")
        ->required()
        ->type_name("DIR");
    cli_.add_option(
            "--methods,--method", methods_,
            "methods to compare: names, each with options if any (a:key=value,b); or a group: geometry, image, all, "
            "or "
            "default, which is geometry and image without the methods that take minutes (or seconds, where the device "
            "is a processor). A method of a group that takes more than 30 seconds for one run is left out, with a "
            "warning, "
            "except with --max-rmse or --frames")
        ->type_name("LIST")
        ->capture_default_str();
    cli_.add_option("--reference", options_.reference,
                    fmt::format("reference of the errors: rays on light samples, areas (exact; slow, see "
                                "--sample-pixels), or any method whose areas are exact, such as {}",
                                session::exact_area_example()))
        ->type_name(fmt::format("{}|NAME:key=value", fmt::join(session::judge_names(), "|")))
        ->capture_default_str();
    cli_.add_option("--reference-samples", options_.reference_samples,
                    "number of light samples of the reference; same: the methods' light samples, so that answers are "
                    "compared pair by pair")
        ->type_name("M|same")
        ->capture_default_str();
    cli_.add_option(
            "--sample-pixels", options_.sample_pixels,
            "pixels whose errors count: N of the judged pixels, all, or x,y;x,y…; areas are computed for these alone")
        ->type_name("N|all|x,y;...")
        ->capture_default_str();
    cli_.add_option("--max-rmse", max_rmse_text_, "exit with 1 if the error of a method exceeds this")->type_name("X");
    cli_.add_option("--runs", options_.runs,
                    "timed runs of each method, after a discarded one; their median counts (default: as many as fit "
                    "into two seconds, one to five)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
    cli_.add_flag("--bits", options_.bits, "also write DIR/<method>.bits: every pair's answer (mask methods)");
    cli_.add_flag("--error-budget", options_.error_budget,
                  "measure the causes of each method's error: run it again with each cause removed in turn, and with "
                  "all removed (ten to twenty runs per method)");
    cli_.add_flag("--png", options_.png, "also write DIR/<method>.png: tone-mapped beauty image (sRGB)");
    cli_.add_option("--stats", options_.stats, "write metrics.json here as well")->type_name("FILE.json");
    cli_.add_option("--frame", frame_, "frame of the scene's animation, or a moment between two, such as 12.5")
        ->type_name("F");
    cli_.add_option("--frames", frames_,
                    "frames of the scene's animation, every N-th: errors over all of them, and how much each method "
                    "flickers compared with the reference; pictures and report are of the last frame")
        ->type_name("A-B[xN]");
    cli_.add_option("--fps", fps_, "frame F is F / fps seconds of a glTF animation (default: 24)")->type_name("N");
    cli_.add_option("--exposure", exposure_,
                    "exposure of the pictures: auto and first (from the reference's lit surfaces) or stops "
                    "(default: auto)")
        ->type_name("auto|first|EV");
    add_tev(cli_, tev_);
    add_refused_options();
  }

  int run(const GlobalOptions& global) override {
    options_.methods = session::parse_methods(methods_);
    options_.method_options = session::parse_method_options(run_.method_options);
    options_.view_arguments = view_arguments(cli_, run_.scene);
    refuse_means();
    if (!max_rmse_text_.empty()) {
      max_rmse_ = session::parse_number(max_rmse_text_);
      if (!max_rmse_ || *max_rmse_ < 0)
        throw UsageError("--max-rmse {}: expected a number of 0 or more, such as 0.01", max_rmse_text_);
    }
    const session::Exposure exposure = session::parse_exposure(exposure_);
    if (exposure.kind == session::Exposure::Kind::fixed) options_.exposure = exposure.stops;
    const double fps = session::parse_fps(fps_);
    if (frame_) options_.time = session::parse_frame(*frame_) * (1 / fps);  // as in `render`
    if (run_.camera == "all")
      throw UsageError("--camera all: errors are of one camera's pixels; name one, and compare once for each");
    TerminalProgress progress(!global.quiet);
    std::optional<session::TevPictures> tev;
    if (!tev_.empty()) options_.tev = &tev.emplace(tev_);
    const compare::Metrics metrics = compared(global.arguments, fps, progress);
    print_table(metrics);
    print_budgets(metrics);
    spdlog::info("{} shows all results", (run_.out / "report.html").string());
    // Failures have already been reported; the results of other methods are written nevertheless.
    const auto failed =
        std::ranges::find_if(metrics.methods, [](const auto& result) { return result.failure.has_value(); });
    const bool exceeded = max_rmse_ && exceeds_max_rmse(metrics);
    if (failed != metrics.methods.end()) return failed->failure->exit_code;
    return static_cast<int>(exceeded ? ExitCode::answer_is_no : ExitCode::done);
  }

 private:
  /// Adds options of `render` that would change the measured quantity: known here so that the error message can give
  /// the reason.
  void add_refused_options() {
    cli_.add_option("--pixel-samples", pixel_samples_, "only 1: errors are measured at pixels' centres")
        ->type_name("1");
    cli_.add_option("--pixel-filter", pixel_filter_, "only box: one view sample a pixel needs no weights")
        ->type_name("box");
    cli_.add_option("--filter-width", filter_width_,
                    "not supported by compare: one view sample a pixel needs no weights")
        ->type_name("PIXELS");
    cli_.add_option("--motion-samples", motion_samples_, "only 1: errors are measured at one moment")->type_name("1");
    cli_.add_option("--shutter", shutter_, "not supported by compare: errors are measured at one moment")
        ->type_name("FRAMES");
    cli_.add_option("--aperture", aperture_, "only 0: errors are measured through the middle of the lens")
        ->type_name("0");
    cli_.add_option("--focus-distance", focus_distance_, "not supported by compare: nothing is out of focus")
        ->type_name("D");
    cli_.add_option("--instances", instances_, "only auto or copies: image-based methods draw every triangle")
        ->type_name("auto|copies");
    cli_.add_option("--light-cutoff", light_cutoff_,
                    "only 0: errors are those of V, which does not depend on a light's strength")
        ->type_name("0");
    cli_.add_flag("--skip-existing", skip_existing_, "not supported by compare: all methods are always measured");
  }

  void refuse_means() const {
    if (session::parse_integer<std::uint32_t>(pixel_samples_) != 1u) {
      throw UsageError("--pixel-samples {}: methods are compared at pixels' centres, one view sample each; expected 1",
                       pixel_samples_);
    }
    if (pixel_filter_ != "box" || !filter_width_.empty()) {
      throw UsageError(
          "--pixel-filter {}: methods are compared at pixels' centres, without weights of a filter; expected box",
          pixel_filter_);
    }
    if (session::parse_integer<std::uint32_t>(motion_samples_) != 1u)
      throw UsageError("--motion-samples {}: methods are compared at one moment; expected 1", motion_samples_);
    if (!shutter_.empty())
      throw UsageError("--shutter {}: methods are compared at one moment (--frame), not over an open shutter",
                       shutter_);
    if (session::parse_number(aperture_) != 0.0 || !focus_distance_.empty())
      throw UsageError("--aperture {}: methods are compared through the lens's middle; expected 0", aperture_);
    if (instances_ != "auto" && instances_ != "copies") {
      throw UsageError(
          "--instances {}: methods are compared on copies of the instances, which all methods support; expected auto "
          "or copies",
          instances_);
    }
    if (session::parse_number(light_cutoff_) != 0.0)
      throw UsageError("--light-cutoff {}: every light's V is compared; expected 0", light_cutoff_);
    if (skip_existing_)
      throw UsageError("--skip-existing: a comparison always measures all methods; earlier results are not kept");
  }

  [[nodiscard]] compare::Metrics compared(const std::vector<std::string>& arguments, double fps,
                                          session::Progress& progress) const {
    if (frames_.empty()) {
      session::ComparisonOptions options = options_;
      if (!max_rmse_) options.most_seconds = kMostGroupSeconds;  // with --max-rmse every method must run
      return session::compare_methods(run_, options, arguments, progress);
    }
    if (frame_) throw UsageError("--frames {} and --frame {}: expected one of them", frames_, *frame_);
    if (options_.error_budget)
      throw UsageError("--error-budget: causes of errors are told apart in one frame (--frame), not in --frames {}",
                       frames_);
    const std::string& pixels = options_.sample_pixels;
    if (pixels != "all" && pixels.find(',') == std::string::npos)
      throw UsageError(
          "--sample-pixels {}: frames are compared at the same pixels; expected all, or pixels such as 10,20;30,40",
          pixels);
    return compare_frames(run_, options_, session::numbers_of(session::parse_frames(frames_)), fps, arguments,
                          progress);
  }

  [[nodiscard]] bool exceeds_max_rmse(const compare::Metrics& metrics) const {
    bool exceeded = false;
    for (const compare::MethodResult& result : metrics.methods) {
      if (result.failure) continue;
      // Without judged pixels the error is unknown, and therefore not shown to be small.
      if (result.error && result.error->rmse <= *max_rmse_) continue;
      exceeded = true;
      spdlog::error("{}: rmse {} exceeds --max-rmse {}", result.entry,
                    result.error ? fmt::format("{}", result.error->rmse) : "(no judged pixels)", *max_rmse_);
    }
    return exceeded;
  }

  session::RunOptions run_;
  session::ComparisonOptions options_;
  std::string methods_ = "default";
  std::optional<double> max_rmse_;
  std::optional<std::string> frame_;
  std::string max_rmse_text_, fps_, exposure_, shutter_, frames_, tev_;
  std::string pixel_samples_ = "1", motion_samples_ = "1", pixel_filter_ = "box", filter_width_, aperture_ = "0",
              focus_distance_, instances_ = "auto", light_cutoff_ = "0";
  bool skip_existing_ = false;
};

}  // namespace

std::unique_ptr<Command> make_compare_command(CLI::App& app) {
  return std::make_unique<CompareCommand>(app);
}

}  // namespace penumbra::app
