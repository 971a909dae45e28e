// SPDX-License-Identifier: Apache-2.0
// Command `render`: frames and cameras one after another, with the next scene read in parallel.

#include "app/commands.hpp"
#include "app/picture_options.hpp"
#include "app/process/process.hpp"
#include "app/process/terminal_progress.hpp"
#include "base/exr.hpp"
#include "scenes/instances.hpp"
#include "session/machine.hpp"
#include "session/methods.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/frames.hpp"
#include "session/pictures/picture_scene.hpp"
#include "session/pictures/request.hpp"
#include "session/pictures/tev_pictures.hpp"
#include "session/process/interrupt.hpp"
#include "session/process/output_files.hpp"
#include "session/process/process_clock.hpp"
#include "session/process/stopwatch.hpp"
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
    add_moments(cli_, options_);
    add_tev(cli_, tev_);
  }

  int run(const GlobalOptions& global) override {
    request_ = session::parse_request(options_);
    is_sequence_ = session::has_frame_number(options_.run.scene) && !std::filesystem::exists(options_.run.scene);
    if (is_sequence_) read_rest();
    session::Exposure exposure = request_.exposure;
    const bool all_cameras = options_.run.camera == "all";
    const std::vector<std::optional<double>>& frames = request_.frames;
    // Cameras' names are in the scene; everything else is checked before the scene is read.
    std::vector<std::string> cameras = {options_.run.camera};
    session::OutputFiles outputs;
    if (!all_cameras) outputs = claim(cameras);
    TerminalProgress progress(!global.quiet);
    const render::Machine machine = session::make_machine(options_.run.device);
    std::optional<session::TevPictures> tev;
    if (!tev_.empty()) tev.emplace(tev_);
    session::FrameRenderer renderer(options_.run, request_.wish, machine, progress);
    if (tev) renderer.show_in(*tev);

    progress.begin("reading " + options_.run.scene.filename().string(), 1);
    std::size_t at = all_cameras ? 0 : next_wanted(cameras, 0);
    if (at == frames.size()) {
      spdlog::info("all {} pictures already exist", frames.size());
      return 0;
    }
    // The device is made while the scene is read, which mostly happens in another process.
    machine.begin(!request_.wish.method.empty() && session::needs_device(request_.wish.method, request_.wish.options));
    session::PictureScene now = read(frames[at]);
    now.seconds = session::seconds_since_start();  // no other work has been done yet
    if (all_cameras) {
      cameras.clear();
      for (const scenes::Camera& camera : now.scene.cameras) {
        visibility::make_camera(camera, {}, 1, 1);  // fails now instead of after the other cameras' pictures
        cameras.push_back(camera.name);
      }
      options_.camera_words = session::camera_words(cameras);
      outputs = claim(cameras);
    }
    outputs.refuse_inputs(now.scene.sources);
    const bool moves = is_sequence_ || now.scene.motion.has_value();
    const bool in_files = !options_.moments.empty();
    if (in_files || (moves && (frames.size() > 1 || request_.moments > 1))) renderer.expect_frames();
    if (frames.size() > 1) renderer.remember_frames();
    if (frames.front() && !moves) {
      progress.clear();
      spdlog::warn("{} has no animation: every frame shows the same", now.scene.name);
    }
    if (exposure.kind == session::Exposure::Kind::first && options_.skip_existing) {
      // An incomplete first picture is rendered now, and determines the exposure again.
      const std::filesystem::path first = session::files_of(options_, frames.front(), cameras.front()).picture;
      if (is_whole_exr(first, session::kExposureAttribute))
        exposure.stops = session::written_exposure(first).value_or(exposure.stops);
    }

    std::size_t last = at;
    while (at < frames.size()) {
      const std::size_t next = next_wanted(cameras, at + 1);
      if (at != last + 1) renderer.forget_frames();  // frames in between were made by another run
      last = at;
      // The next scene is read by a separate process while this one is rendered.
      std::future<session::PictureScene> coming;
      if (moves && next < frames.size())
        coming = std::async(std::launch::async, [this, frame = frames[next]] { return read(frame); });
      for (const std::string& camera : cameras) {
        const session::FrameFiles files = session::files_of(options_, frames[at], camera);
        if (options_.skip_existing) {
          if (files.all_there()) {
            renderer.forget_frames();
            continue;
          }
          progress.clear();
          for (const std::filesystem::path& file : files.spoilt())
            spdlog::warn("{} is incomplete, or was not written by this command: it is rendered again", file.string());
        }
        const bool is_last = &camera == &cameras.back() && (coming.valid() || next >= frames.size());
        auto moments =
            in_files ? session::moments_in_files(options_, request_, now) : moments_of(frames[at], moves, now.ahead);
        renderer.render(is_last ? std::move(now.scene) : scenes::Scene(now.scene),
                        {frames[at], camera, request_.pixel_side, request_.filter, request_.pixel_tolerance,
                         std::move(moments), &now.instances, false, request_.light_cutoff},
                        files.bits, now.seconds);
        now.seconds = 0;  // counted once
        const std::string made = session::summary(renderer.write(files, exposure));
        spdlog::info("{}{}", frames[at] ? files.picture.filename().string() + ": " : "", made);
        session::check_interrupt();
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
    session::RunOptions first = options_.run;
    first.scene = session::first_frame_path(first.scene);
    first.studio = {};
    first.studio.never = true;
    scenes::ReadOptions reading = session::read_options(first.gltf, first.allow_outside);
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

  /// Returns the scenes at moment_times; empty if one scene is sufficient. `ahead`: scenes that were read with the
  /// first one.
  [[nodiscard]] std::vector<std::function<session::PictureScene()>> moments_of(
      std::optional<double> frame, bool moves, const std::shared_ptr<scenes::ScenesAhead>& ahead) const {
    std::vector<std::function<session::PictureScene()>> all;
    if (!moves) return all;
    for (const double time : moment_times(frame))
      all.emplace_back(
          [this, time, ahead] { return session::read_picture_scene(options_.run, time, request_, ahead.get()); });
    return all;
  }

  [[nodiscard]] session::PictureScene read(std::optional<double> frame) const {
    std::optional<double> time;
    if (frame && !is_sequence_) time = *frame * request_.seconds_per_frame;
    session::RunOptions run = options_.run;
    if (is_sequence_) run.scene = session::frame_path(run.scene, std::llround(*frame));
    const auto ahead = std::make_shared<scenes::ScenesAhead>();
    ahead->times = moment_times(frame);
    session::PictureScene scene = session::read_picture_scene(run, time, request_, ahead.get());
    scene.ahead = ahead;
    return scene;
  }

  [[nodiscard]] session::OutputFiles claim(const std::vector<std::string>& cameras) const {
    session::OutputFiles outputs = session::outputs_of(options_, request_.frames, cameras);
    outputs.require_writable();
    session::check_png_name(options_);
    return outputs;
  }

  /// Returns the first frame from `from` on with a file to be made.
  [[nodiscard]] std::size_t next_wanted(const std::vector<std::string>& cameras, std::size_t from) const {
    const auto& frames = request_.frames;
    while (options_.skip_existing && from < frames.size() && is_there(options_, frames[from], cameras)) ++from;
    return std::min(from, frames.size());
  }

  session::PictureOptions options_;
  session::PictureRequest request_;
  bool is_sequence_ = false;  // the scene is one file per frame
  std::string tev_;           // HOST:PORT
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& app) {
  return std::make_unique<RenderCommand>(app);
}

}  // namespace penumbra::app
