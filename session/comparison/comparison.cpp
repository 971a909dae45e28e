// SPDX-License-Identifier: Apache-2.0
// Runs a comparison: reference, rays, methods, and all files of its folder.

#include "session/comparison/comparison.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/png.hpp"
#include "compare/error_picture.hpp"
#include "compare/eye.hpp"
#include "compare/metrics_csv.hpp"
#include "compare/report.hpp"
#include "render/device.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/comparison/comparison_files.hpp"
#include "session/comparison/entry_run.hpp"
#include "session/comparison/error_budget.hpp"
#include "session/comparison/error_classes.hpp"
#include "session/comparison/light_judge.hpp"
#include "session/comparison/reference_samples.hpp"
#include "session/comparison/report_views.hpp"
#include "session/comparison/separated_beauty.hpp"
#include "session/machine.hpp"
#include "session/methods.hpp"
#include "session/output.hpp"
#include "session/pictures/picture_file.hpp"
#include "session/process/failure.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "session/whole_lights.hpp"
#include "visibility/floats_memory.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::Light;
using visibility::Output;

class Comparison {
 public:
  /// Largest size of the masks by rays of all lights together, which are kept while the methods run.
  static constexpr std::uint64_t kMostRayBytes = std::uint64_t{1} << 30;
  /// Number of repetitions of the search for view samples if no number of runs is requested.
  static constexpr std::uint32_t kViewRuns = 3;

  /// `scene`: nullopt: read from the run's file.
  Comparison(const RunOptions& run, const ComparisonOptions& options, std::optional<scenes::Scene> scene,
             Progress& progress)
      : run_(run),
        format_(parse_format(run.format)),
        options_(options),
        progress_(progress),
        reference_(describe_reference(options.reference)),
        same_samples_(options.reference_samples == "same"),
        files_(run.out, {.png = options.png, .bits = options.bits}),
        machine_(make_machine(run.device)),
        runner_({session_, machine_, options, files_, format_, wanted_, progress,
                 [this](std::string text) { warn(std::move(text)); }}) {
    reference_request_ = reference_samples(run, options.reference_samples);
    if (options.error_budget) require_explainable(options.methods);
    if (options.writes) files_.claim(run.scene, options.methods, options.stats);
    const std::uint32_t looks = options.runs != 0 ? options.runs : kViewRuns;
    session_ = scene ? open_session(std::move(*scene), run, machine_, looks, progress)
                     : open_session(run, options.time, machine_, looks, progress, bytes_per_copy(options));
    if (options.writes) files_.refuse_inputs(session_.scene.sources);
    check_layers(format_, session_, false);
    progress.clear();
    for (const scenes::Object& object : session_.scene.objects) {
      if (object.alpha.mode != scenes::Alpha::Mode::blend) continue;
      session_.warnings.push_back(fmt::format(
          "\"{}\" is translucent: pictures here show what is behind it (render composites it over that)", object.name));
    }
    if (options.time && !session_.scene.motion)
      progress.warn(session_.scene.name + " has no animation: every frame shows the same");
    for (const std::string& warning : session_.warnings) progress.warn(warning);
    for (const Light& light : session_.lights) check_light(reference_.description, light);
    if (wants_bits(reference_, options)) check_bits(reference_.description, session_.lights);
    entries_ = choose_entries(options, session_, machine_, [this](std::string text) { warn(std::move(text)); });
    reference_lights_ = same_samples_ ? session_.lights : with_samples(session_, reference_request_);
    truths_ = choose_pixels(session_, options.sample_pixels);
    const std::vector<std::string> names = whole_names(session_.lights);
    for (std::size_t light = 0; light < truths_.size(); ++light) {
      if (!truths_[light].judged.empty()) continue;
      const std::string of_light = truths_.size() > 1 ? fmt::format("light {}: ", names[light]) : "";
      warn(of_light +
           "no pixel is judged (none sees the whole light above its tangent plane, or --sample-pixels chose none): "
           "there is no error to report");
    }
    if (options_.sample_pixels != "all") wanted_ = all_pixels(truths_);
  }

  compare::Metrics run(const std::vector<std::string>& arguments) {
    run_reference();
    run_rays();
    run_entries();
    if (options_.writes) make_error_pictures();
    if (options_.error_budget) explain_errors();
    progress_.clear();
    if (!options_.writes) {
      if (hang_) std::rethrow_exception(hang_);
      return std::move(report_.metrics);
    }
    const std::string json = compare::json_text(compare::to_json(report_.metrics));
    write_file_atomically(run_.out / "metrics.json", json);
    write_file_atomically(run_.out / "metrics.csv", compare::metrics_csv(report_.metrics));
    if (!options_.stats.empty()) write_file_atomically(options_.stats, json);
    finish_report(arguments);
    compare::write_report(run_.out / "report.html", report_);
    if (hang_) std::rethrow_exception(hang_);
    return std::move(report_.metrics);
  }

  /// Returns the errors; valid after all runs.
  [[nodiscard]] EntryErrors errors() const {
    EntryErrors all;
    for (const auto& of_lights : visibility_) {
      all.push_back(of_lights.empty() ? std::vector<float>() : judged_errors(of_lights.front(), truths_.front()));
    }
    return all;
  }

 private:
  /// Returns the size of all lights' masks, on the methods' light samples.
  [[nodiscard]] std::uint64_t mask_bytes() const {
    std::uint64_t words = 0;
    for (const Light& light : session_.lights) words += std::uint64_t{session_.pixel_count()} * light.words_per_mask();
    return words * sizeof(std::uint32_t);
  }

  /// Returns a sink that keeps the complete masks of rays, light by light: every method's masks are compared with them.
  [[nodiscard]] TileSink keep_rays() {
    return [this, whole_of = wholes_of_pieces(session_.lights)](const TileResult& tile) {
      auto& pieces = truths_[whole_of[tile.light]].ray_masks;
      const std::size_t piece = session_.lights[tile.light].piece;
      pieces.resize(std::max(pieces.size(), piece + 1));
      pieces[piece].insert(pieces[piece].end(), tile.masks.begin(), tile.masks.end());
    };
  }

  void run_reference() {
    const bool rays = same_samples_ && reference_.description.output == Output::mask;
    if (rays) {
      require_memory(mask_bytes(), "the reference's masks",
                     "choose a smaller --size or fewer --light-samples, or leave out --reference-samples same");
    }
    EntryRun done =
        runner_.run(reference_, true, reference_lights_, rays ? keep_rays() : TileSink([](const TileResult&) {}));
    report_.exposure = options_.exposure ? std::exp2(*options_.exposure) : auto_exposure(session_, done.beauty);
    report_.metrics.reference = runner_.stats_of(reference_, reference_lights_, done.run);
    report_.metrics.judged_pixels = truths_.front().judged.size();
    report_.metrics.horizon_pixels = truths_.front().horizon.size();
    report_.reference = seen_by(reference_, done);
    reference_picture_ = std::move(done.picture);
    for (std::size_t light = 0; light < truths_.size(); ++light) {
      if (rays) truths_[light].rays = done.run.visibility[light];
      truths_[light].reference = std::move(done.run.visibility[light]);
    }
    try {
      sort_into_classes(session_, truths_, progress_);
    } catch (const Error& error) {  // a reference of areas supports lights that rays do not
      if (error.code() == ExitCode::interrupted) throw;
      warn(fmt::format("errors are not listed separately by the object that casts the shadow: {}", error.what()));
    }
    reference_beauty_ = std::move(done.beauty);
    if (std::ranges::any_of(entries_, [](const Entry& e) { return e.description.output == Output::scalar; }) &&
        reference_.description.output != Output::scalar)
      separated_ = separated_beauty(session_, truths_);
  }

  /// Compares methods with masks against rays on their own light samples, whatever the reference's samples: separates
  /// errors of the method from the effect of the number of light samples. Runs once, untimed.
  void run_rays() {
    if (!truths_.front().ray_masks.empty()) return;
    if (std::ranges::none_of(entries_, [](const Entry& e) { return e.description.output == Output::mask; })) return;
    if (mask_bytes() > kMostRayBytes) {
      warn(
          fmt::format("masks of rays on the same light samples would take {} MiB: pairs are not compared; "
                      "--reference-samples same compares them nevertheless",
                      mask_bytes() >> 20));
      return;
    }
    const Entry rays{"rays", ray_judge(), {}};
    const auto method = make_method(rays.description.name, rays.options, machine_);
    PackedMasks masks(session_.lights.size());
    const TileSink keep = keep_rays();
    EntryRun done;
    MethodRun run = run_method(
        *method, session_, {.lights = session_.lights, .runs = 1, .pixels = wanted_},
        [&](const TileResult& tile) {
          keep(tile);
          masks.add(tile);
        },
        progress_);
    done.run = of_whole_lights(std::move(run), session_);
    progress_.clear();
    compare::SampleCost cost;
    cost.stats = runner_.stats_of(rays, session_.lights, done.run);
    cost.stats.seconds = {};  // not comparable: one run without warm-up
    cost.all_lights_error = error_of_all_lights(done.run, truths_);
    cost.lights = LightJudge(session_, truths_, 0).judge(done.run, progress_);
    report_.rays = report_entry(session_, rays.description, {done.run, {}, masks.finish()});
    report_.metrics.same_samples = std::move(cost);
    for (std::size_t light = 0; light < truths_.size(); ++light)
      truths_[light].rays = std::move(done.run.visibility[light]);
  }

  /// Runs all entries, and removes those that take too long.
  void run_entries() {
    std::vector<Entry> kept;
    for (Entry& entry : entries_) {
      try {
        run_or_report(entry);
        kept.push_back(std::move(entry));
      } catch (const TakesTooLong& found) {
        leave_out(entry, found.seconds);
      }
    }
    entries_ = std::move(kept);
    if (entries_.empty() && !report_.metrics.left_out.empty())
      throw UsageError(
          "all methods are left out, since each takes longer than {:.0f} seconds: request one by name (--methods)",
          options_.most_seconds);
  }

  void leave_out(const Entry& entry, double seconds) {
    progress_.clear();
    const auto has_budget = [](const visibility::OptionDescription& option) { return option.name == "budget"; };
    const bool bounded = std::ranges::any_of(entry.description.options, has_budget);
    warn(
        fmt::format("{} is left out: a run would take about {:.0f} seconds here, and the limit for methods that are "
                    "not requested by name is {:.0f}; request it by name (--methods){}",
                    entry.label, seconds, options_.most_seconds,
                    bounded ? fmt::format(", or bound its texels: {}:budget=4096", entry.label) : ""));
    report_.metrics.left_out.push_back({entry.label, seconds, options_.most_seconds});
    if (!options_.writes) return;
    for (std::string& text : files_.remove(entry.label)) warn(std::move(text));
  }

  /// A method that fails does not end the comparison of the others. After a device stops answering, no other method
  /// runs, and the device's exception is rethrown once everything is written.
  void run_or_report(const Entry& entry) {
    if (hang_) {
      report_failure(entry, {ExitCode::resource, "not run, since the device no longer answers"});
      return;
    }
    try {
      run_entry(entry);
    } catch (const render::DeviceDoesNotAnswer& error) {
      hang_ = std::current_exception();
      report_failure(entry, {error.code(), error.what()});
    } catch (const TakesTooLong&) {
      throw;
    } catch (...) {
      report_failure(entry, current_failure());
    }
  }

  void report_failure(const Entry& entry, const Failure& failure) {
    progress_.clear();
    const bool is_named = failure.message.starts_with(entry.label + ": ");
    progress_.error(is_named ? failure.message : fmt::format("{}: {}", entry.label, failure.message));
    compare::MethodResult result;
    result.entry = entry.label;
    result.stats = runner_.stats_of(entry, session_.lights, {});
    result.stats.seconds = {};
    result.failure = {static_cast<int>(failure.code), failure.message};
    report_.metrics.methods.push_back(std::move(result));
    report_.methods.emplace_back().description = entry.description;
    visibility_.emplace_back();
    if (!options_.writes) return;
    for (std::string& text : files_.remove(entry.label)) warn(std::move(text));
  }

  void run_entry(const Entry& entry) {
    const bool pairs_of_reference = same_samples_ && reference_.description.output == Output::mask;
    // Exact decisions take milliseconds each: a small number is sufficient for verdicts, and a large one is used if
    // pairs were requested.
    LightJudge judge(session_, truths_, pairs_of_reference ? 4000 : 400);
    EntryRun done = runner_.run(entry, false, session_.lights, [&](const TileResult& tile) { judge.add(tile); });

    compare::MethodResult result;
    result.entry = entry.label;
    result.stats = runner_.stats_of(entry, session_.lights, done.run);
    const auto of_method = std::span(result.stats.warnings).subspan(session_.warnings.size());
    for (const std::string& warning : of_method) progress_.warn(warning);
    judge.fill(result, done.run, pairs_of_reference, progress_);
    judge.count_texels(result.lights, done.run, entry.description,
                       visibility::complete_options(entry.description, result.stats.options));
    result.beauty_error = compare::beauty_error(done.beauty, reference_beauty_, truths_.front().judged);
    if (entry.description.output == Output::scalar && !separated_.empty()) {
      result.separation = compare::separation({done.beauty, separated_, reference_beauty_}, truths_.front().judged);
    }
    compare::ReportEntry seen = seen_by(entry, done);
    if (options_.sample_pixels == "all") result.flip = compare::flip_of(reference_picture_, done.picture);
    report_.metrics.methods.push_back(std::move(result));
    report_.methods.push_back(std::move(seen));
    visibility_.push_back(std::move(done.run.visibility));
  }

  /// Returns the report's numbers of a run, and keeps its beauty as a picture in `done`.
  compare::ReportEntry seen_by(const Entry& entry, EntryRun& done) {
    done.picture = to_srgb(session_.width, session_.height, done.beauty, report_.exposure);
    if (options_.png && options_.writes) write_png(files_.of(entry.label, ".png"), done.picture);
    return report_entry(session_, entry.description, {done.run, done.beauty, std::move(done.masks), reference_beauty_});
  }

  /// Runs last, because all pictures share one scale.
  void make_error_pictures() {
    double largest = 0;
    for (const compare::MethodResult& result : report_.metrics.methods) {
      if (result.all_lights_error) largest = std::max(largest, result.all_lights_error->max);
    }
    report_.error_limit = compare::error_scale_limit(largest);
    for (std::size_t i = 0; i < visibility_.size(); ++i) {
      if (visibility_[i].empty()) continue;  // the entry failed
      write_png(files_.of(report_.metrics.methods[i].entry, "-error.png"),
                compare::error_picture(session_.samples, visibility_[i].front(), truths_.front().reference,
                                       report_.error_limit));
    }
  }

  /// Computes error budgets; pictures of the change by repairs use the known scale of the errors.
  void explain_errors() {
    const std::vector<WholeLight> wholes = whole_lights(session_.lights);
    for (const WholeLight& whole : wholes) {
      if (whole.count == 1) continue;
      warn(fmt::format("no error budget under light \"{}\": it is cut in {} pieces", session_.lights[whole.first].name,
                       whole.count));
    }
    std::vector<BudgetRuns> runs(truths_.size());
    for (std::size_t i = 0; i < entries_.size() && !hang_; ++i) {
      if (entries_[i].description.repairs == nullptr || visibility_[i].empty()) continue;
      try {
        for (std::size_t light = 0; light < truths_.size(); ++light) {
          if (truths_[light].judged.empty() || wholes[light].count > 1) continue;
          BudgetAnswer answer = measure_error_budget({session_, session_.lights[wholes[light].first], truths_[light],
                                                      reference_request_, entries_[i], visibility_[i][light]},
                                                     report_.error_limit, machine_, runs[light], progress_);
          report_.metrics.methods[i].lights[light].error_budget = std::move(answer.budget);
          report_.methods[i].lights[light].budget_pictures = std::move(answer.pictures);
        }
      } catch (const render::DeviceDoesNotAnswer&) {
        hang_ = std::current_exception();
        warn(fmt::format("{}: no error budget, since the device no longer answers", entries_[i].label));
      }
    }
  }

  void finish_report(const std::vector<std::string>& arguments) {
    report_.version = PENUMBRA_VERSION;
    report_.arguments = arguments;
    report_.view_arguments = options_.view_arguments;
    report_.scene = compare::describe_scene(session_.scene, session_.camera_index);
    report_.lights = report_lights(session_, reference_lights_, same_samples_);
    report_.same_samples = same_samples_;
    report_.sampled_pixels = options_.sample_pixels == "all" ? 0 : truths_.front().judged.size();
    report_.machine = compare::this_machine();
    report_.warnings = warnings_;
  }

  void warn(std::string text) {
    progress_.clear();
    progress_.warn(text);
    warnings_.push_back(std::move(text));
  }

  const RunOptions& run_;
  PictureFormat format_;
  const ComparisonOptions& options_;
  Progress& progress_;
  const Entry reference_;
  bool same_samples_;
  visibility::SampleRequest reference_request_;
  ComparisonFiles files_;
  render::Machine machine_;
  Session session_;
  std::optional<std::vector<std::uint32_t>>
      wanted_;  ///< pixels of all lights' truths, if --sample-pixels chose some; nullopt: every pixel
  EntryRunner runner_;
  std::vector<Light> reference_lights_;
  std::vector<Entry> entries_;
  std::vector<LightTruth> truths_;  ///< of each light
  std::vector<glm::vec3> reference_beauty_;
  Image8 reference_picture_;
  std::vector<glm::vec3> separated_;  ///< V of the reference · ∫G; empty: not requested, or unknown
  std::vector<std::vector<std::vector<float>>> visibility_;  ///< of each entry, of each light; empty: the entry failed
  std::vector<std::string> warnings_;
  compare::ReportInput report_;
  std::exception_ptr hang_;  ///< exception of a device that does not answer; the device must not be used again
};

}  // namespace

std::uint64_t bytes_per_copy(const ComparisonOptions& options) {
  std::uint64_t most = describe_reference(options.reference).description.bytes_per_triangle;
  for (const MethodEntry& entry : options.methods) {
    if (!entry.from_group) most = std::max(most, describe_method(entry.name).bytes_per_triangle);
  }
  return visibility::kFloatsOfTriangle + most;
}

compare::Metrics compare_methods(const RunOptions& run, const ComparisonOptions& options,
                                 const std::vector<std::string>& arguments, Progress& progress, EntryErrors* errors) {
  Comparison comparison(run, options, std::nullopt, progress);
  compare::Metrics metrics = comparison.run(arguments);
  if (errors != nullptr) *errors = comparison.errors();
  return metrics;
}

compare::Metrics compare_methods(scenes::Scene scene, const RunOptions& run, const ComparisonOptions& options,
                                 Progress& progress) {
  return Comparison(run, options, std::move(scene), progress).run({});
}

}  // namespace penumbra::session
