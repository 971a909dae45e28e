// SPDX-License-Identifier: Apache-2.0
// Command `submit`: renders the missing frames of a sequence here or by Slurm.

#include "app/commands.hpp"
#include "app/farm/batch_script.hpp"
#include "app/farm/slurm.hpp"
#include "app/farm/tasks.hpp"
#include "app/farm/workers.hpp"
#include "app/picture_options.hpp"
#include "app/process/child_program.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "scenes/instances.hpp"
#include "session/pictures/picture_file.hpp"
#include "session/pictures/request.hpp"
#include "session/process/output_files.hpp"
#include "session/session.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

namespace penumbra::app {
namespace {

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class SubmitCommand : public Command {
 public:
  explicit SubmitCommand(CLI::App& app)
      : Command(app, "submit", "render a sequence on a farm: as a Slurm array, or here with several workers") {
    add_picture_options(cli_, options_);
    cli_.get_option("--frames")->required();
    auto* dry_run =
        cli_.add_flag("--dry-run", dry_run_, "prints the batch script, without rendering, writing or calling Slurm");
    auto* jobs = cli_.add_option("--jobs", jobs_, "number of processes that render here at a time, without Slurm")
                     ->type_name("N")
                     ->check(CLI::Range(1, 1024))
                     ->excludes(dry_run);
    const auto add = [&](const char* name, auto& value, const char* help) {
      return cli_.add_option(name, value, help)->excludes(jobs);
    };
    add("--chunk", chunk_,
        "number of frames in each task of the array (default: as many as take a minute, judged by the first frame, "
        "which is rendered here)")
        ->type_name("N")
        ->check(CLI::Range(1, 100'000));
    add("--rounds", rounds_, "largest number of times that missing frames are submitted, the first time included")
        ->type_name("N")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    add("--round", round_, "number of this round; set by the summary of the previous round")
        ->type_name("N")
        ->check(CLI::Range(1, 101))
        ->capture_default_str();
    cli_.add_option(
            "--logs", logs_,
            "folder for a log of each frame; without Slurm; tasks of an array write these logs next to their own logs")
        ->type_name("DIR");
    add("--sbatch", sbatch_, "option for sbatch: partition=NAME, time=HOURS:MM:SS, mem=8G …; may be given again")
        ->type_name("KEY[=VALUE]")
        ->allow_extra_args(false);
  }

  int run(const GlobalOptions& global) override {
    if (options_.exposure.empty()) options_.exposure = "first";
    request_ = session::parse_request(options_);
    range_ = session::parse_frames(options_.frames);
    frames_ = session::numbers_of(range_);
    for (const std::string& option : sbatch_) refuse_option(option);
    read_cameras();
    session::outputs_of(options_, request_.frames, cameras_);  // throws for files with the same name
    session::check_png_name(options_);
    words_ = words_for_all(global);
    folder_ = folder_of(absolute(options_.run.out));
    if (std::error_code error; !logs_.empty() && !std::filesystem::create_directories(logs_, error) && error)
      throw ResourceError("--logs {}: {}", logs_.string(), error.message());
    if (jobs_ > 0) return render_here();
    if (folder_.string().find('\\') != std::string::npos) {
      // A backslash means to Slurm that no %A of the name is to be replaced.
      throw UsageError("{}: Slurm cannot write logs into a folder with a backslash in its name; rename it",
                       folder_.string());
    }
    return dry_run_ ? print_script() : submit();
  }

 private:
  // ---- the command line

  static std::filesystem::path absolute(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
  }

  static void refuse_option(const std::string& option) {
    const std::string name = option.substr(0, option.find('='));
    const bool plain =
        !name.empty() && std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
    if (!plain || name.starts_with('-') || option.find('\n') != std::string::npos)
      throw UsageError("--sbatch {}: expected a long option of sbatch without its dashes, such as partition=render",
                       option);
    if (is_own_option(name)) throw UsageError("--sbatch {}: `submit` sets this one itself", option);
  }

  /// Returns all given options of render, except those set for each task; paths are absolute.
  [[nodiscard]] std::vector<std::string> words_for_all(const GlobalOptions& global) const {
    const std::vector<std::string> own = {"--frames", "--exposure", "--skip-existing", "--dry-run", "--jobs", "--chunk",
                                          "--rounds", "--round",    "--sbatch",        "--logs",    "--help"};
    const std::vector<std::string> files = {"SCENE", "--output", "--stats", "--png", "--bits"};
    const auto is_one_of = [](const std::vector<std::string>& names, const CLI::Option* option) {
      return std::ranges::any_of(names, [&](const std::string& name) { return option->check_name(name); });
    };
    std::vector<std::string> words;
    for (const CLI::Option* option : cli_.get_options()) {
      if (option->count() == 0 || is_one_of(own, option)) continue;
      const bool positional = option->get_lnames().empty();
      for (const std::string& given : option->results()) {
        const std::string value = is_one_of(files, option) ? absolute(given).string() : given;
        const std::string name = positional ? "" : "--" + option->get_lnames().front();
        words.push_back(positional ? value : option->get_items_expected_max() == 0 ? name : name + "=" + value);
      }
    }
    if (global.quiet) words.emplace_back("--quiet");
    if (global.verbose) words.emplace_back("--verbose");
    for (const std::string& word : words) {
      if (word.find('\n') != std::string::npos)
        throw UsageError("{}: a name with a line break in it cannot be submitted; rename it", shell_word(word));
    }
    return words;
  }

  /// Returns the folder next to the pictures, named after them: OUT.####.exr → OUT.farm.
  static std::filesystem::path folder_of(const std::filesystem::path& out) {
    const std::string name = session::sequence_name(out);
    return out.parent_path() / ((name.empty() ? "frames" : name) + ".farm");
  }

  void read_cameras() {
    cameras_ = {options_.run.camera};
    if (options_.run.camera != "all") return;
    cameras_.clear();  // their names are in the scene
    const double time = static_cast<double>(frames_.front()) * request_.seconds_per_frame;
    scenes::Instances instances;
    const scenes::Scene scene = session::read_session_scene(options_.run, time, {.instances = &instances});
    for (const scenes::Camera& camera : scene.cameras) cameras_.push_back(camera.name);
    options_.camera_words = session::camera_words(cameras_);
  }

  // ---- existing files

  [[nodiscard]] bool has(std::int64_t frame) const {
    return session::is_there(options_, static_cast<double>(frame), cameras_);
  }
  [[nodiscard]] std::vector<std::int64_t> missing() const {
    std::vector<std::int64_t> frames = frames_;
    std::erase_if(frames, [this](std::int64_t frame) { return has(frame); });
    return frames;
  }
  [[nodiscard]] std::filesystem::path picture(std::int64_t frame) const {
    return session::files_of(options_, static_cast<double>(frame), cameras_.front()).picture;
  }

  // ---- rendering on this machine

  [[nodiscard]] Workers workers(const std::string& exposure, std::size_t at_once) const {
    std::vector<std::string> command = {own_program(), "render"};
    command.insert(command.end(), words_.begin(), words_.end());
    command.insert(command.end(), {"--exposure=" + exposure, "--skip-existing"});
    return {std::move(command), range_.step, at_once, [this](std::int64_t frame) { return has(frame); }, logs_};
  }

  /// Returns the exposure of the frames, in the form of --exposure. If none is requested, the first frame determines
  /// it: that frame is rendered if missing. If rendering fails, the next frame determines it, and so on; failed frames
  /// are added to `failed`.
  std::string decide_exposure(std::vector<FailedFrame>& failed) {
    if (request_.exposure.kind == session::Exposure::Kind::automatic) return "auto";
    if (request_.exposure.kind == session::Exposure::Kind::fixed) return fmt::format("{}", request_.exposure.stops);
    for (const std::int64_t frame : frames_) {
      if (!has(frame)) {
        const std::vector<FailedFrame> now = render_frames(workers("first", 1), {frame});
        failed.insert(failed.end(), now.begin(), now.end());
        constexpr std::size_t kEnough = 3;
        if (failed.size() == kEnough) throw Error(static_cast<ExitCode>(now.front().code), give_up(failed));
        if (!now.empty()) {
          spdlog::warn(
              "frame {}, which determines the exposure (--exposure first), failed: the next frame determines it",
              frame);
          continue;
        }
      }
      if (const auto stops = session::written_exposure(picture(frame))) return fmt::format("{}", *stops);
      spdlog::warn("{} does not contain its exposure: the next frame determines it", picture(frame).string());
    }
    return "auto";  // there is no frame left to be exposed
  }

  static std::string give_up(const std::vector<FailedFrame>& failed) {
    std::string text = "the first frames fail, and the others were not tried:";
    for (const FailedFrame& one : failed) text += fmt::format("\nframe {}: {}", one.frame, one.reason);
    return text;
  }

  int render_here() {
    const std::size_t before = missing().size();
    if (before == 0) {
      spdlog::info("all {} frames exist", frames_.size());
      return 0;
    }
    std::vector<FailedFrame> failed;
    const std::string exposure = decide_exposure(failed);
    std::vector<std::int64_t> rest = missing();
    std::erase_if(rest, [&](std::int64_t frame) {
      return std::ranges::find(failed, frame, &FailedFrame::frame) != failed.end();
    });
    if (!rest.empty()) {
      const auto more = render_frames(workers(exposure, static_cast<std::size_t>(jobs_)), rest);
      failed.insert(failed.end(), more.begin(), more.end());
    }
    for (const FailedFrame& one : failed) spdlog::error("frame {}: {}", one.frame, one.reason);
    if (failed.empty()) {
      spdlog::info("all {} frames exist", frames_.size());
      return 0;
    }
    spdlog::error("{} of {} frames failed; repeat the command to render only these", failed.size(), frames_.size());
    return failed.front().code;
  }

  // ---- the farm

  /// Renders a frame here as the farm would, and returns its cost. Throws the error of the frame.
  FrameCost measure(std::int64_t frame, const std::string& exposure) {
    session::PictureOptions named = options_;
    Workers here = workers(exposure, 1);
    here.logs = folder_;
    if (named.stats.empty()) {
      named.stats = folder_ / "first-frame.json";
      here.command.push_back("--stats=" + named.stats.string());
    }
    here.is_there = [&](std::int64_t one) { return session::is_there(named, static_cast<double>(one), cameras_); };
    spdlog::info("frame {} is rendered here, to see how many frames a task can do", frame);
    const std::vector<FailedFrame> failed = render_frames(here, {frame});
    if (!failed.empty()) {
      throw Error(static_cast<ExitCode>(failed.front().code),
                  fmt::format("frame {}: {}; nothing was submitted", frame, failed.front().reason));
    }
    FrameCost cost;
    for (const std::string& camera : cameras_) {
      const auto seconds =
          nlohmann::json::parse(text_of_file(session::files_of(named, static_cast<double>(frame), camera).stats))
              .at("seconds");
      const double total = seconds.at("total").get<double>();
      double own = 0;
      for (const char* phase : {"view", "light", "evaluate", "beauty", "write"}) own += seconds.value(phase, 0.0);
      if (camera == cameras_.front()) cost.begin = std::max(total - own, 0.0);
      cost.frame += own;
    }
    return cost;
  }

  [[nodiscard]] BatchJob job_of(const std::vector<std::int64_t>& frames, std::size_t chunk, std::size_t most) const {
    BatchJob job;
    job.program = own_program();
    job.words = words_;
    for (const session::FrameRange& task : cut_into_tasks(frames, range_.step, chunk, most))
      job.tasks.push_back(text_of(task));
    job.sbatch = sbatch_;
    job.folder = folder_;
    job.name = "penumbra-" + session::file_name_of(folder_.stem().string());
    job.summary = {"--frames=" + text_of(range_), "--exposure=" + asked_exposure(), fmt::format("--chunk={}", chunk),
                   fmt::format("--rounds={}", rounds_), fmt::format("--round={}", round_ + 1)};
    for (const std::string& option : sbatch_) job.summary.push_back("--sbatch=" + option);
    return job;
  }

  [[nodiscard]] std::string asked_exposure() const {
    using Kind = session::Exposure::Kind;
    const Kind kind = request_.exposure.kind;
    return kind == Kind::first       ? "first"
           : kind == Kind::automatic ? "auto"
                                     : fmt::format("{}", request_.exposure.stops);
  }

  int print_script() {
    const std::vector<std::int64_t> frames = missing();
    if (frames.empty()) {
      spdlog::info("all {} frames exist", frames_.size());
      return 0;
    }
    BatchJob job = job_of(frames, static_cast<std::size_t>(chunk_.value_or(1)), kDefaultMostTasks);
    job.exposure = asked_exposure();
    if (request_.exposure.kind == session::Exposure::Kind::first) {
      const std::filesystem::path first = absolute(picture(frames_.front()));
      job.exposure = first.string();
      if (!has(frames_.front()))
        job.first_frame = fmt::format("--frames={}-{} --exposure=first", frames_.front(), frames_.front());
    }
    if (!chunk_) spdlog::info("--dry-run measures nothing, so each task has one frame; --chunk N sets another number");
    fmt::print("{}", text_of(job));
    return 0;
  }

  int submit() {
    const std::filesystem::path queued = folder_ / "array-job";
    const std::string before = text_of_file(queued);
    if (round_ == 1 && !before.empty() && is_queued(before)) {
      throw UsageError("these frames are being rendered as job {} (squeue --jobs={}); wait, or scancel it first",
                       before, before);
    }
    std::vector<std::int64_t> frames = missing();
    if (frames.empty()) {
      spdlog::info("all {} frames exist", frames_.size());
      return 0;
    }
    if (round_ > rounds_ || (round_ > 1 && !before.empty() && was_cancelled(before))) return report(frames);

    session::OutputFolder made;
    made.make(folder_);
    const std::size_t most = most_tasks(run_slurm({"scontrol", "show", "config"}));
    std::string exposure = asked_exposure();
    std::optional<FrameCost> cost;
    if (request_.exposure.kind == session::Exposure::Kind::first) {
      const std::int64_t first = frames_.front();
      if (!has(first)) cost = measure(first, "first");
      const auto stops = session::written_exposure(picture(first));
      if (!stops) {
        throw InputError("{} does not contain its exposure; remove it, or give --exposure in stops",
                         picture(first).string());
      }
      exposure = fmt::format("{}", *stops);
    }
    if (!chunk_ && !cost) cost = measure(frames.front(), exposure);
    frames = missing();
    if (frames.empty()) {
      spdlog::info("all {} frames exist", frames_.size());
      return 0;
    }
    const std::size_t chunk = chunk_ ? static_cast<std::size_t>(*chunk_) : frames_per_task(*cost);
    if (cost)
      spdlog::info("{:.2f} s to start and {:.2f} s per frame: {} frames per task", cost->begin, cost->frame, chunk);
    BatchJob job = job_of(frames, chunk, most);
    job.exposure = exposure;
    write_file_atomically(script_of(job), text_of(job));
    const std::string array = job_number(run_slurm(sbatch_array(job)));
    write_file_atomically(queued, array);
    const std::string summary = job_number(run_slurm(sbatch_summary(job, array)));
    spdlog::info("{} frames in {} tasks are job {}, its summary is job {}; scripts and logs are in {}", frames.size(),
                 job.tasks.size(), array, summary, folder_.string());
    fmt::print("{} {}\n", array, summary);
    return 0;
  }

  [[nodiscard]] int report(const std::vector<std::int64_t>& frames) const {
    spdlog::error("{} of {} frames are missing: {}", frames.size(), frames_.size(), list_of(frames, range_.step));
    spdlog::error("grep 'frame {}:' {}/*.log shows why; the same `penumbra submit` renders only the missing frames",
                  frames.front(), shell_word(folder_.string()));
    return static_cast<int>(ExitCode::answer_is_no);
  }

  session::PictureOptions options_;
  bool dry_run_ = false;
  int jobs_ = 0;
  std::optional<int> chunk_;
  int rounds_ = 2, round_ = 1;
  std::vector<std::string> sbatch_;
  std::filesystem::path logs_;

  // Parsed options:
  session::PictureRequest request_;
  session::FrameRange range_;
  std::vector<std::int64_t> frames_;
  std::vector<std::string> cameras_;
  std::vector<std::string> words_;  // after the subcommand's name, for every task
  std::filesystem::path folder_;    // of script and logs
};

}  // namespace

std::unique_ptr<Command> make_submit_command(CLI::App& app) {
  return std::make_unique<SubmitCommand>(app);
}

}  // namespace penumbra::app
