#include "app/comparison.hpp"

#include "app/device_source.hpp"
#include "app/failure.hpp"
#include "app/mask_comparison.hpp"
#include "app/methods.hpp"
#include "app/output.hpp"
#include "app/output_files.hpp"
#include "app/runner.hpp"
#include "app/sample_pixels.hpp"
#include "app/session.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/png.hpp"
#include "compare/error_picture.hpp"
#include "compare/report.hpp"
#include "render/device.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

namespace penumbra::app {
namespace {

using visibility::Light;
using visibility::MethodDescription;
using visibility::Output;

/// A method as asked for, with what its options make of it.
struct Entry {
  std::string label;
  MethodDescription description;
  visibility::MethodOptions options;
};

/// A run with what is made of it on the way.
struct Finished {
  MethodRun run;
  std::vector<glm::vec3> beauty;
};

class Comparison {
 public:
  Comparison(const RunOptions& run, const ComparisonOptions& options, Progress& progress)
      : run_(run),
        options_(options),
        progress_(progress),
        reference_(describe_reference(options.reference)),
        same_samples_(options.reference_samples == "same"),
        devices_(run.device) {
    reference_request_ = parse_reference_samples();
    prepare_folder();
    session_ = open_session(run, devices_, options.runs, progress);
    outputs_.refuse_inputs(session_.scene.sources);
    progress.clear();
    for (const std::string& warning : session_.warnings) spdlog::warn("{}", warning);
    choose_entries();
    reference_lights_ = same_samples_ ? session_.lights : lights_of_reference();
    const auto& classes = session_.classes.front();
    judged_ = sample_pixels(compare::pixels_of_class(classes, visibility::PixelClass::judged), options.sample_pixels,
                            session_.width, session_.height);
    horizon_ = sample_pixels(compare::pixels_of_class(classes, visibility::PixelClass::horizon), options.sample_pixels,
                             session_.width, session_.height);
    if (judged_.empty()) {
      warn(
          "no pixel is judged (none sees the whole light above its tangent plane, or --sample-pixels chose none): "
          "there is no error to report");
    }
    if (options_.sample_pixels != "all") {
      wanted_.emplace();
      std::ranges::merge(judged_, horizon_, std::back_inserter(*wanted_));
    }
  }

  compare::Metrics run(const std::vector<std::string>& arguments) {
    run_reference();
    for (const Entry& entry : entries_) run_or_report(entry);
    write_error_pictures();
    progress_.clear();
    const std::string json = compare::json_text(compare::to_json(report_.metrics));
    write_file_atomically(run_.out / "metrics.json", json);
    if (!options_.stats.empty()) write_file_atomically(options_.stats, json);
    finish_report(arguments);
    compare::write_report(run_.out / "report.html", report_);
    if (hang_) std::rethrow_exception(hang_);
    return std::move(report_.metrics);
  }

 private:
  static Entry describe_reference(const std::string& name) {
    const MethodDescription& description = describe_method(name);
    if (description.family != visibility::Family::reference) {
      throw UsageError("--reference {}: a {} method is no judge; expected raytrace or exact", name,
                       visibility::name_of(description.family));
    }
    return {"reference", description, {}};
  }

  [[nodiscard]] visibility::SampleRequest parse_reference_samples() const {
    RunOptions reference = run_;
    if (!same_samples_) reference.light_samples = options_.reference_samples;
    try {
      return parse_light_samples(reference);
    } catch (const UsageError&) {
      if (same_samples_) throw;
      throw UsageError("--reference-samples {}: expected a number of light samples from 1 to 4096, or same",
                       options_.reference_samples);
    }
  }

  void prepare_folder() {
    folder_.make(run_.out);
    outputs_.add("-o", run_.out / "metrics.json");
    outputs_.add("-o", run_.out / "report.html");
    outputs_.add("--stats", options_.stats);
    for (const std::filesystem::path& file : files_of("reference")) outputs_.add("-o", file);
    for (const MethodEntry& entry : options_.methods) {
      for (const std::filesystem::path& file : files_of(entry.label)) outputs_.add("-o", file);
      outputs_.add("-o", file_of(entry.label, "-error.png"));
    }
    outputs_.refuse_inputs({&run_.scene, 1});
    outputs_.require_writable();
  }

  /// Refuses, before anything long, what would fail later; leaves out of a group what cannot do the lights.
  void choose_entries() {
    for (const Light& light : session_.lights) check_light(reference_.description, light);
    if (wants_bits(reference_)) check_bits(reference_.description, session_.lights.front());
    for (const MethodEntry& chosen : with_method_options()) {
      // With its options: they may change what it gives and which lights it can do.
      Entry entry{chosen.label, describe_method(chosen.name, chosen.options), chosen.options};
      if (chosen.from_group && !can_do(entry.description, session_.lights)) {
        warn(fmt::format("{} is left out: it cannot do every light of the scene", entry.label));
        continue;
      }
      for (const Light& light : session_.lights) check_light(entry.description, light);
      if (wants_bits(entry)) check_bits(entry.description, session_.lights.front());
      entries_.push_back(std::move(entry));
    }
    if (entries_.empty()) {
      throw InputError(
          "none of the chosen methods can do the lights of {}; name one that can with --methods (see "
          "`penumbra methods`)",
          session_.scene.name);
    }
  }

  /// The chosen methods, each with those of --method-option that it has.
  [[nodiscard]] std::vector<MethodEntry> with_method_options() const {
    std::vector<MethodEntry> entries = options_.methods;
    for (const auto& [key, value] : options_.method_options) {
      bool known = false;
      for (MethodEntry& entry : entries) {
        const auto& has = describe_method(entry.name).options;
        if (std::ranges::find(has, key, &visibility::OptionDescription::name) == has.end()) continue;
        entry.options.emplace(key, value);  // an entry's own option stands
        known = true;
      }
      if (!known) throw UsageError("--method-option {}={}: none of the chosen methods has such an option", key, value);
    }
    return entries;
  }

  [[nodiscard]] std::vector<Light> lights_of_reference() const {
    std::vector<Light> lights;
    for (const Light& light : session_.lights) {
      lights.push_back(visibility::make_light(session_.scene, static_cast<std::uint32_t>(light.index),
                                              session_.floats.origin, reference_request_));
    }
    return lights;
  }

  void run_reference() {
    const bool keep_masks = same_samples_ && reference_.description.output == Output::mask;
    if (keep_masks) {
      const std::uint64_t words = std::uint64_t{session_.pixel_count()} * reference_lights_.front().words_per_mask();
      require_memory(words * sizeof(std::uint32_t), "the reference's masks",
                     "choose a smaller --size or fewer --light-samples, or leave out --reference-samples same");
      reference_masks_.reserve(words);
    }
    Finished done = run_one(reference_, reference_lights_, [&](const TileResult& tile) {
      if (keep_masks && tile.light == 0) {
        reference_masks_.insert(reference_masks_.end(), tile.masks.begin(), tile.masks.end());
      }
    });
    report_.exposure = compare::auto_exposure(done.beauty);
    report_.metrics.reference = make_stats(session_, reference_lights_, label_of(reference_), done.run);
    report_.metrics.judged_pixels = judged_.size();
    report_.metrics.horizon_pixels = horizon_.size();
    report_.reference = pictures_of(reference_, done);
    reference_visibility_ = std::move(done.run.visibility.front());
    reference_beauty_ = std::move(done.beauty);
  }

  /// One method that fails is no reason to lose what the others have to say. After a device that does not answer no
  /// other method runs, and what it threw is thrown on once everything is written.
  void run_or_report(const Entry& entry) {
    if (hang_) {
      report_failure(entry, {ExitCode::resource, "not run, since the device does not answer any more"});
      return;
    }
    try {
      run_entry(entry);
    } catch (const render::DeviceDoesNotAnswer& error) {
      hang_ = std::current_exception();
      report_failure(entry, {error.code(), error.what()});
    } catch (...) {
      report_failure(entry, current_failure());
    }
  }

  void report_failure(const Entry& entry, const Failure& failure) {
    progress_.clear();
    spdlog::error("{}: {}", entry.label, failure.message);
    compare::MethodResult result;
    result.entry = entry.label;
    result.stats = make_stats(session_, session_.lights, label_of(entry), {});
    result.stats.seconds = {};
    result.failure = {static_cast<int>(failure.code), failure.message};
    report_.metrics.methods.push_back(std::move(result));
    report_.methods.emplace_back().description = entry.description;
    visibility_.emplace_back();
    remove_files(entry);
  }

  /// What lies there is of an earlier run, or of one that did not end: it would pass for what this report speaks of.
  /// Other files are not touched: they may be anything.
  void remove_files(const Entry& entry) {
    std::vector<std::filesystem::path> files = files_of(entry.label);
    files.push_back(file_of(entry.label, "-error.png"));
    for (const std::filesystem::path& file : files) {
      std::error_code error;
      const auto status = std::filesystem::symlink_status(file, error);
      if (!std::filesystem::exists(status)) continue;
      if (!std::filesystem::is_regular_file(status)) {
        warn(fmt::format("{} is of an earlier run, and no regular file: it stays", file.string()));
        continue;
      }
      std::filesystem::remove(file, error);
      if (error) warn(fmt::format("{} is of an earlier run and cannot be removed: {}", file.string(), error.message()));
    }
  }

  void run_entry(const Entry& entry) {
    std::optional<MaskComparison> judge;
    if (!reference_masks_.empty() && entry.description.output == Output::mask) {
      judge.emplace(session_, reference_masks_);
    }
    Finished done = run_one(entry, session_.lights, [&](const TileResult& tile) {
      if (judge && tile.light == 0) judge->add(tile);
    });

    compare::MethodResult result;
    result.entry = entry.label;
    result.stats = make_stats(session_, session_.lights, label_of(entry), done.run);
    result.error = compare::visibility_error(done.run.visibility.front(), reference_visibility_, judged_);
    result.horizon_error = compare::visibility_error(done.run.visibility.front(), reference_visibility_, horizon_);
    result.beauty_error = compare::beauty_error(done.beauty, reference_beauty_, judged_);
    if (judge) {
      result.pairs = judge->counts();
      result.verdicts = judge->decide(progress_);
      result.stats.counters["exactDecided"] = result.verdicts->decided;
      result.stats.counters["methodRight"] = result.verdicts->method_right;
      result.stats.counters["referenceRight"] = result.verdicts->reference_right;
      if (!judge->kept_all()) {
        result.stats.warnings.push_back(
            fmt::format("{}: {} pairs differ; {} of them, evenly spaced, were decided exactly", entry.label,
                        result.pairs->differing, result.verdicts->decided));
      }
    }
    compare::ReportEntry pictures = pictures_of(entry, done);
    report_.metrics.methods.push_back(std::move(result));
    report_.methods.push_back(std::move(pictures));
    visibility_.push_back(std::move(done.run.visibility.front()));
  }

  /// Runs a method and writes its EXR and, if wanted, its bits.
  Finished run_one(const Entry& entry, const std::vector<Light>& lights, const TileSink& sink) {
    const MethodDescription& description = entry.description;
    const auto method = make_method(description.name, entry.options, devices_);
    BeautyAccumulator beauty(session_, lights);
    std::optional<BitsOutput> bits;
    if (wants_bits(entry)) bits.emplace(file_of(entry.label, ".bits"), session_, lights.front());
    RunPlan plan{.lights = lights, .runs = options_.runs, .discard_first = true, .pixels = wanted_};
    // An oracle without samples is not raced, and it may take minutes: once is enough.
    if (description.family == visibility::Family::reference && description.output != Output::mask) {
      plan.runs = 1;
      plan.discard_first = false;
    }
    Finished done;
    done.run = run_method(
        *method, session_, plan,
        [&](const TileResult& tile) {
          beauty.add(tile);
          if (bits && tile.light == 0) bits->add(tile);
          sink(tile);
        },
        progress_);
    done.beauty = beauty.pixels();
    devices_.check_validation();
    progress_.clear();
    write_picture(file_of(entry.label, ".exr"), session_, lights, label_of(entry), done.run, done.beauty);
    if (bits) bits->commit();
    return done;
  }

  [[nodiscard]] bool wants_bits(const Entry& entry) const {
    return options_.bits && entry.description.output == Output::mask;
  }

  [[nodiscard]] MethodLabel label_of(const Entry& entry) const {
    return {entry.description, entry.options, device_of(entry.description, devices_.name())};
  }

  compare::ReportEntry pictures_of(const Entry& entry, const Finished& done) {
    compare::ReportEntry pictures;
    pictures.description = entry.description;
    pictures.beauty = to_srgb(session_.width, session_.height, done.beauty, report_.exposure);
    pictures.visibility = compare::visibility_picture(session_.samples, done.run.visibility.front());
    if (options_.png) write_png(file_of(entry.label, ".png"), *pictures.beauty);
    return pictures;
  }

  /// Last, because all share one scale.
  void write_error_pictures() {
    double largest = 0;
    for (const compare::MethodResult& result : report_.metrics.methods) {
      if (result.error) largest = std::max(largest, result.error->max);
    }
    report_.error_limit = compare::error_scale_limit(largest);
    for (std::size_t i = 0; i < visibility_.size(); ++i) {
      if (visibility_[i].empty()) continue;  // it failed
      report_.methods[i].error =
          compare::error_picture(session_.samples, visibility_[i], reference_visibility_, report_.error_limit);
      write_png(file_of(report_.metrics.methods[i].entry, "-error.png"), *report_.methods[i].error);
    }
  }

  void finish_report(const std::vector<std::string>& arguments) {
    report_.version = PENUMBRA_VERSION;
    report_.arguments = arguments;
    report_.scene = compare::describe_scene(session_.scene, session_.camera_index);
    report_.light = session_.lights.front().name;
    report_.same_samples = same_samples_;
    report_.sampled_pixels = options_.sample_pixels == "all" ? 0 : judged_.size();
    report_.machine = compare::this_machine();
    report_.warnings = warnings_;
  }

  /// What a run of that name writes, without the error picture.
  [[nodiscard]] std::vector<std::filesystem::path> files_of(const std::string& name) const {
    std::vector<std::filesystem::path> files = {file_of(name, ".exr")};
    if (options_.png) files.push_back(file_of(name, ".png"));
    if (options_.bits) files.push_back(file_of(name, ".bits"));
    return files;
  }

  [[nodiscard]] std::filesystem::path file_of(const std::string& name, const char* ending) const {
    return run_.out / (name + ending);
  }

  void warn(std::string text) {
    progress_.clear();
    spdlog::warn("{}", text);
    warnings_.push_back(std::move(text));
  }

  const RunOptions& run_;
  const ComparisonOptions& options_;
  Progress& progress_;
  const Entry reference_;
  bool same_samples_;
  visibility::SampleRequest reference_request_;
  OutputFolder folder_;
  OutputFiles outputs_;
  DeviceSource devices_;
  Session session_;
  std::vector<Light> reference_lights_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> judged_, horizon_;       ///< pixels that errors are taken over
  std::optional<std::vector<std::uint32_t>> wanted_;  ///< both, if --sample-pixels chose; nothing: all pixels
  std::vector<std::uint32_t> reference_masks_;        ///< of the first light; empty unless pairs can be compared
  std::vector<float> reference_visibility_;           ///< of the first light
  std::vector<glm::vec3> reference_beauty_;
  std::vector<std::vector<float>> visibility_;  ///< of each entry, of the first light; empty: it failed
  std::vector<std::string> warnings_;
  compare::ReportInput report_;
  std::exception_ptr hang_;  ///< what a device that does not answer threw; it must not be used again
};

}  // namespace

compare::Metrics compare_methods(const RunOptions& run, const ComparisonOptions& options,
                                 const std::vector<std::string>& arguments, Progress& progress) {
  return Comparison(run, options, progress).run(arguments);
}

}  // namespace penumbra::app
