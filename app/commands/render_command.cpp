#include "app/commands.hpp"
#include "app/pictures/frame_render.hpp"
#include "app/pictures/frames.hpp"
#include "app/process/interrupt.hpp"
#include "app/methods.hpp"
#include "app/options.hpp"
#include "app/process/output_files.hpp"
#include "app/process/process.hpp"
#include "app/parse.hpp"
#include "app/process/stopwatch.hpp"
#include "base/error.hpp"
#include "visibility/view_samples.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <future>
#include <optional>
#include <utility>

namespace penumbra::app {
namespace {

/// A scene with what reading it took.
struct ReadScene {
  scenes::Scene scene;
  double seconds = 0;
};

class RenderCommand : public Command {
 public:
  explicit RenderCommand(CLI::App& app) : Command(app, "render", "render one image, or a sequence, with one method") {
    add_run_options(cli_, options_);
    cli_.add_option("-o,--output", options_.out,
                    "image to write: linear beauty and V, of each light too, positions, normals, ids")
        ->required()
        ->type_name("OUT.exr");
    cli_.add_option("--method", wish_.method,
                    "shadow method, see `penumbra methods` (default: for each light the best one that gives its exact "
                    "area; where light samples are asked for, or none does, the best geometry-based one, or raytrace)")
        ->type_name("NAME");
    cli_.add_option("--stats", stats_, "times, counters and warnings as JSON; times of one run, the first")
        ->type_name("FILE.json");
    cli_.add_option("--png", png_, "the beauty for eyes")->type_name("FILE.png");
    cli_.add_option("--exposure", exposure_,
                    "of the PNG: auto (lit surfaces fill it; light bodies do not count), first (a sequence's first "
                    "frame decides for all) or stops (default: auto)")
        ->type_name("auto|first|EV");
    cli_.add_option("--bits", bits_, "every pair's answer for the first light (penumbra-bits/1; mask methods)")
        ->type_name("FILE");
    auto* frame = cli_.add_option("--frame", frame_, "frame of the scene's animation")->type_name("F");
    cli_.add_option(
            "--frames", frames_,
            "a sequence, every N-th frame of it; files are numbered where their names say \"####\" or \"%04d\", "
            "else before the extension")
        ->type_name("A-B[xN]")
        ->excludes(frame);
    cli_.add_option("--fps", fps_, "frame F is F / fps seconds of a glTF animation (default: 24)")->type_name("N");
    cli_.add_option("--pixel-samples", pixel_samples_,
                    "view samples a pixel on a square grid, of which R G B A and V are the mean: 1, 4, 9 … 64 "
                    "(default: 1, the pixel's centre)")
        ->type_name("S");
    cli_.add_option(
            "--motion-samples", motion_samples_,
            "moments of an open shutter, of which R G B A and V are the mean: 1 to 256 (default: 1, the frame's)")
        ->type_name("N");
    cli_.add_option("--shutter", shutter_, "how long it is open, in frames, around the frame's time (default: 0.5)")
        ->type_name("FRAMES");
    cli_.add_flag("--skip-existing", skip_existing_,
                  "leave out pictures whose files are all there: resumes a sequence");
  }

  int run(const GlobalOptions& global) override {
    wish_.options = parse_method_options(options_.method_options);
    if (!wish_.method.empty()) describe_method(wish_.method, wish_.options);  // refuses now what would be refused later
    wish_.samples = !options_.light_samples.empty() || !options_.sample_pattern.empty() || !bits_.empty();
    Exposure exposure = parse_exposure(exposure_);
    seconds_per_frame_ = 1 / parse_fps(fps_);
    parse_means();
    if (options_.out.extension() != ".exr") {
      throw UsageError("-o {}: expected a name that ends in .exr (--png writes a PNG file beside it)",
                       options_.out.string());
    }
    const bool all_cameras = options_.camera == "all";
    const std::vector<std::optional<std::int64_t>> frames = frame_numbers();
    // Cameras' names are in the scene; everything else is refused before it is read.
    std::vector<std::string> cameras = {options_.camera};
    OutputFiles outputs;
    if (!all_cameras) claim(outputs, frames, cameras);
    if (!png_.empty() && png_.extension() != ".png") {
      throw UsageError("--png {}: expected a name that ends in .png", png_.string());
    }
    Progress progress(!global.quiet);
    DeviceSource devices(options_.device);
    FrameRenderer renderer(options_, wish_, devices, progress);

    progress.begin("reading " + options_.scene.filename().string(), 1);
    std::size_t at = all_cameras ? 0 : next_wanted(frames, cameras, 0);
    if (at == frames.size()) {
      spdlog::info("all {} pictures are there", frames.size());
      return 0;
    }
    ReadScene now;
    {
      const MayExitAtOnce at_once;
      now = read(frames[at]);
      now.seconds = seconds_since_start();  // nothing else has been done yet
    }
    if (all_cameras) {
      cameras.clear();
      for (const scenes::Camera& camera : now.scene.cameras) {
        visibility::make_camera(camera, {}, 1, 1);  // refuses now what would be refused after the others' pictures
        cameras.push_back(camera.name);
      }
      claim(outputs, frames, cameras);
    }
    outputs.refuse_inputs(now.scene.sources);
    const bool moves = now.scene.motion.has_value();
    if (frames.front() && !moves) {
      progress.clear();
      spdlog::warn("{} has no animation: every frame shows the same", now.scene.name);
    }
    if (exposure.kind == Exposure::Kind::first && skip_existing_) {
      const std::filesystem::path first = files_of(frames.front(), cameras.front()).picture;
      const auto stops = written_exposure(first);
      if (!stops && std::filesystem::exists(first)) {
        progress.clear();
        spdlog::warn("{} does not say how it was exposed: the first frame that is rendered decides", first.string());
      }
      exposure.stops = stops.value_or(exposure.stops);
    }

    while (at < frames.size()) {
      const std::size_t next = next_wanted(frames, cameras, at + 1);
      // The next scene is read while this one is rendered, by a process of its own.
      std::future<ReadScene> coming;
      if (moves && next < frames.size())
        coming = std::async(std::launch::async, [this, frame = frames[next]] { return read(frame); });
      for (const std::string& camera : cameras) {
        const FrameFiles files = files_of(frames[at], camera);
        if (skip_existing_ && files.all_there()) continue;
        renderer.render(now.scene, {frames[at], camera, pixel_side_, moments_of(frames[at], moves)}, files.bits,
                        now.seconds);
        now.seconds = 0;  // once
        spdlog::info("{}", summary(renderer.write(files, exposure)));
        check_interrupt();
      }
      if (coming.valid()) now = coming.get();
      at = next;
    }
    return 0;
  }

 private:
  void parse_means() {
    const auto whole = [](const std::string& text, const char* option, std::uint32_t most, const char* wanted) {
      const auto value = parse_integer<std::uint32_t>(text.empty() ? "1" : text);
      if (!value || *value < 1 || *value > most) throw UsageError("{} {}: expected {}", option, text, wanted);
      return *value;
    };
    const char* const squares = "a square number from 1 to 64, such as 4, 9 or 16";
    const std::uint32_t samples = whole(pixel_samples_, "--pixel-samples", 64, squares);
    while (pixel_side_ * pixel_side_ < samples) ++pixel_side_;
    if (pixel_side_ * pixel_side_ != samples)
      throw UsageError("--pixel-samples {}: expected {}", pixel_samples_, squares);
    moments_ = whole(motion_samples_, "--motion-samples", 256, "a number from 1 to 256");
    const auto shutter = parse_number(shutter_.empty() ? "0.5" : shutter_);
    if (!shutter || !(*shutter >= 0 && *shutter <= 100))
      throw UsageError("--shutter {}: expected frames from 0 to 100, such as 0.5", shutter_);
    shutter_frames_ = *shutter;
    if (!bits_.empty() && (samples > 1 || moments_ > 1))
      throw UsageError(
          "--bits: answers are of pixels' centres at one moment; leave out --pixel-samples and --motion-samples");
    if (moments_ > 1 && frames_.empty() && !frame_)
      throw UsageError("--motion-samples {}: of which frame? --frame or --frames says", motion_samples_);
  }

  /// The middle of each of so many equal parts of the time that the shutter is open; none if one is enough.
  [[nodiscard]] std::vector<std::function<scenes::Scene()>> moments_of(std::optional<std::int64_t> frame,
                                                                       bool moves) const {
    std::vector<std::function<scenes::Scene()>> all;
    if (!frame || !moves || moments_ == 1) return all;
    for (std::uint32_t i = 0; i < moments_; ++i) {
      const double offset = shutter_frames_ * ((i + 0.5) / moments_ - 0.5);
      const double time = (static_cast<double>(*frame) + offset) * seconds_per_frame_;
      all.emplace_back([this, time] { return read_session_scene(options_, time); });
    }
    return all;
  }

  /// One entry without a number if no frame was asked for.
  [[nodiscard]] std::vector<std::optional<std::int64_t>> frame_numbers() const {
    if (frames_.empty()) return {frame_};
    std::vector<std::optional<std::int64_t>> all;
    for (const std::int64_t frame : numbers_of(parse_frames(frames_))) all.emplace_back(frame);
    return all;
  }

  [[nodiscard]] ReadScene read(std::optional<std::int64_t> frame) const {
    const Stopwatch watch;
    std::optional<double> time;
    if (frame) time = static_cast<double>(*frame) * seconds_per_frame_;
    ReadScene read;
    read.scene = read_session_scene(options_, time);
    read.seconds = watch.seconds();
    return read;
  }

  /// Named after camera and frame, where there are several.
  [[nodiscard]] FrameFiles files_of(std::optional<std::int64_t> frame, const std::string& camera) const {
    const auto named = [&](std::filesystem::path path) {
      if (path.empty()) return path;
      if (options_.camera == "all") path = camera_path(path, camera);
      return frame && (!frames_.empty() || has_frame_number(path)) ? frame_path(path, *frame) : path;
    };
    return {named(options_.out), named(stats_), named(png_), named(bits_)};
  }

  void claim(OutputFiles& outputs, const std::vector<std::optional<std::int64_t>>& frames,
             const std::vector<std::string>& cameras) const {
    for (const auto& frame : frames) {
      for (const std::string& camera : cameras) {
        for (const auto& [option, path] : files_of(frame, camera).all()) outputs.add(option, path);
      }
    }
    outputs.refuse_inputs({&options_.scene, 1});
    outputs.require_writable();
  }

  /// The first frame from `from` on of which something is to be made.
  [[nodiscard]] std::size_t next_wanted(const std::vector<std::optional<std::int64_t>>& frames,
                                        const std::vector<std::string>& cameras, std::size_t from) const {
    const auto is_wanted = [&](const std::optional<std::int64_t>& frame) {
      return std::ranges::any_of(cameras, [&](const auto& camera) { return !files_of(frame, camera).all_there(); });
    };
    while (skip_existing_ && from < frames.size() && !is_wanted(frames[from])) ++from;
    return std::min(from, frames.size());
  }

  RunOptions options_;
  MethodWish wish_;
  std::optional<std::int64_t> frame_;
  std::string frames_, fps_, exposure_, pixel_samples_, motion_samples_, shutter_;
  std::uint32_t pixel_side_ = 1, moments_ = 1;
  double shutter_frames_ = 0.5;
  bool skip_existing_ = false;
  double seconds_per_frame_ = 0;
  std::filesystem::path stats_, png_, bits_;
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& app) {
  return std::make_unique<RenderCommand>(app);
}

}  // namespace penumbra::app
