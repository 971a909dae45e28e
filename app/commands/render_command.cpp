// SPDX-License-Identifier: Apache-2.0
// Command `render`: frames and cameras one after another, with the next scene read in parallel.

#include "app/process/terminal_progress.hpp"
#include "app/commands.hpp"
#include "app/machine.hpp"
#include "app/methods.hpp"
#include "app/pictures/frame_render.hpp"
#include "app/pictures/frames.hpp"
#include "app/pictures/picture_scene.hpp"
#include "app/pictures/request.hpp"
#include "app/pictures/tev_pictures.hpp"
#include "app/process/interrupt.hpp"
#include "app/process/output_files.hpp"
#include "app/process/process.hpp"
#include "app/process/stopwatch.hpp"
#include "base/exr.hpp"
#include "scenes/instances.hpp"
#include "visibility/view_samples.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <utility>

namespace penumbra::app {
namespace {

class RenderCommand : public Command {
 public:
  explicit RenderCommand(CLI::App& app) : Command(app, "render", "render one image, or a sequence, with one method") {
    add_picture_options(cli_, options_);
    cli_.add_option(
            "--frame", options_.frame,
            "one frame of the scene's animation, or a moment between two, such as 12.5; files are numbered only "
            "if their names have a place for the number")
        ->type_name("F")
        ->excludes(cli_.get_option("--frames"));
    add_tev(cli_, tev_);
  }

  int run(const GlobalOptions& global) override {
    request_ = parse_request(options_);
    is_sequence_ = has_frame_number(options_.run.scene) && !std::filesystem::exists(options_.run.scene);
    if (is_sequence_) read_rest();
    Exposure exposure = request_.exposure;
    const bool all_cameras = options_.run.camera == "all";
    const std::vector<std::optional<double>>& frames = request_.frames;
    // Cameras' names are in the scene; everything else is checked before the scene is read.
    std::vector<std::string> cameras = {options_.run.camera};
    OutputFiles outputs;
    if (!all_cameras) outputs = claim(cameras);
    TerminalProgress progress(!global.quiet);
    const render::Machine machine = make_machine(options_.run.device);
    std::optional<TevPictures> tev;
    if (!tev_.empty()) tev.emplace(tev_);
    FrameRenderer renderer(options_.run, request_.wish, machine, progress);
    if (tev) renderer.show_in(*tev);

    progress.begin("reading " + options_.run.scene.filename().string(), 1);
    std::size_t at = all_cameras ? 0 : next_wanted(cameras, 0);
    if (at == frames.size()) {
      spdlog::info("all {} pictures are there", frames.size());
      return 0;
    }
    // The device is made while the scene is read, mostly by another process.
    machine.begin(!request_.wish.method.empty() && needs_device(request_.wish.method, request_.wish.options));
    PictureScene now = read(frames[at]);
    now.seconds = seconds_since_start();  // no other work has been done yet
    if (all_cameras) {
      cameras.clear();
      for (const scenes::Camera& camera : now.scene.cameras) {
        visibility::make_camera(camera, {}, 1, 1);  // fails now instead of after the other cameras' pictures
        cameras.push_back(camera.name);
      }
      options_.camera_words = camera_words(cameras);
      outputs = claim(cameras);
    }
    outputs.refuse_inputs(now.scene.sources);
    const bool moves = is_sequence_ || now.scene.motion.has_value();
    if (moves && (frames.size() > 1 || request_.moments > 1)) renderer.expect_frames();
    if (frames.size() > 1) renderer.remember_frames();
    if (frames.front() && !moves) {
      progress.clear();
      spdlog::warn("{} has no animation: every frame shows the same", now.scene.name);
    }
    if (exposure.kind == Exposure::Kind::first && options_.skip_existing) {
      // An incomplete first picture is rendered now, and determines the exposure again.
      const std::filesystem::path first = files_of(options_, frames.front(), cameras.front()).picture;
      if (is_whole_exr(first, kExposureAttribute)) exposure.stops = written_exposure(first).value_or(exposure.stops);
    }

    std::size_t last = at;
    while (at < frames.size()) {
      const std::size_t next = next_wanted(cameras, at + 1);
      if (at != last + 1) renderer.forget_frames();  // the frames between were made by another run
      last = at;
      // The next scene is read while this one is rendered, by a process of its own.
      std::future<PictureScene> coming;
      if (moves && next < frames.size())
        coming = std::async(std::launch::async, [this, frame = frames[next]] { return read(frame); });
      for (const std::string& camera : cameras) {
        const FrameFiles files = files_of(options_, frames[at], camera);
        if (options_.skip_existing) {
          if (files.all_there()) {
            renderer.forget_frames();
            continue;
          }
          progress.clear();
          for (const std::filesystem::path& file : files.spoilt())
            spdlog::warn("{} is cut off, or no file that this command wrote: it is made again", file.string());
        }
        const bool is_last = &camera == &cameras.back() && (coming.valid() || next >= frames.size());
        renderer.render(is_last ? std::move(now.scene) : scenes::Scene(now.scene),
                        {frames[at], camera, request_.pixel_side, request_.filter, request_.pixel_tolerance,
                         moments_of(frames[at], moves, now.ahead), &now.instances, false, request_.light_cutoff},
                        files.bits, now.seconds);
        now.seconds = 0;  // counted once
        const std::string made = summary(renderer.write(files, exposure));
        spdlog::info("{}{}", frames[at] ? files.picture.filename().string() + ": " : "", made);
        check_interrupt();
      }
      if (coming.valid()) now = coming.get();
      at = next;
    }
    return 0;
  }

 private:
  /// Reads the first file of a scene that is one file per frame. Throws UsageError for requests other than whole
  /// frames.
  void read_rest() {
    const std::string name = options_.run.scene.filename().string();
    const auto between = [](std::optional<double> frame) { return !frame || *frame != std::floor(*frame); };
    if (std::ranges::any_of(request_.frames, between))
      throw UsageError("{} is one file per frame: --frame or --frames must select whole frames", name);
    if (request_.moments > 1)
      throw UsageError("--motion-samples: {} is one file per frame, without moments between the files", name);
    RunOptions first = options_.run;
    first.scene = first_frame_path(first.scene);
    first.studio = {};
    first.studio.never = true;
    scenes::ReadOptions reading = read_options(first.gltf, first.allow_outside);
    reading.needs_light = false;
    options_.run.rest = std::make_shared<const scenes::Scene>(scenes::read_scene(first.scene, reading));
  }

  /// Returns the middle of each of the equal parts of the time that the shutter is open, in seconds; empty for a
  /// picture of one moment.
  [[nodiscard]] std::vector<double> moment_times(std::optional<double> frame) const {
    std::vector<double> times;
    for (std::uint32_t i = 0; frame && request_.moments > 1 && i < request_.moments; ++i) {
      const double offset = request_.shutter_frames * ((i + 0.5) / request_.moments - 0.5);
      times.push_back((*frame + offset) * request_.seconds_per_frame);
    }
    return times;
  }

  /// Returns the scenes at moment_times; empty if one scene is sufficient. `ahead`: what was read with the first one.
  [[nodiscard]] std::vector<std::function<PictureScene()>> moments_of(
      std::optional<double> frame, bool moves, const std::shared_ptr<scenes::ScenesAhead>& ahead) const {
    std::vector<std::function<PictureScene()>> all;
    if (!moves) return all;
    for (const double time : moment_times(frame))
      all.emplace_back([this, time, ahead] { return read_picture_scene(options_.run, time, request_, ahead.get()); });
    return all;
  }

  [[nodiscard]] PictureScene read(std::optional<double> frame) const {
    std::optional<double> time;
    if (frame && !is_sequence_) time = *frame * request_.seconds_per_frame;
    RunOptions run = options_.run;
    if (is_sequence_) run.scene = frame_path(run.scene, std::llround(*frame));
    const auto ahead = std::make_shared<scenes::ScenesAhead>();
    ahead->times = moment_times(frame);
    PictureScene scene = read_picture_scene(run, time, request_, ahead.get());
    scene.ahead = ahead;
    return scene;
  }

  [[nodiscard]] OutputFiles claim(const std::vector<std::string>& cameras) const {
    OutputFiles outputs = outputs_of(options_, request_.frames, cameras);
    outputs.require_writable();
    check_png_name(options_);
    return outputs;
  }

  /// Returns the first frame from `from` on with a file to be made.
  [[nodiscard]] std::size_t next_wanted(const std::vector<std::string>& cameras, std::size_t from) const {
    const auto& frames = request_.frames;
    while (options_.skip_existing && from < frames.size() && is_there(options_, frames[from], cameras)) ++from;
    return std::min(from, frames.size());
  }

  PictureOptions options_;
  PictureRequest request_;
  bool is_sequence_ = false;  // the scene is one file per frame
  std::string tev_;           // HOST:PORT
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& app) {
  return std::make_unique<RenderCommand>(app);
}

}  // namespace penumbra::app
