#include "app/commands.hpp"
#include "app/light_methods.hpp"
#include "app/methods.hpp"
#include "app/options.hpp"
#include "app/output.hpp"
#include "app/process/output_files.hpp"
#include "app/runner.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/png.hpp"
#include "compare/error_picture.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

namespace penumbra::app {
namespace {

class RenderCommand : public Command {
 public:
  explicit RenderCommand(CLI::App& app) : Command(app, "render", "render one image with one method") {
    add_run_options(cli_, options_);
    cli_.add_option("-o,--output", options_.out, "image to write: linear beauty, V, positions, normals, ids")
        ->required()
        ->type_name("OUT.exr");
    cli_.add_option("--method", method_,
                    "shadow method, see `penumbra methods` (default: for each light the best one that gives its exact "
                    "area; where light samples are asked for, or none does, the best geometry-based one, or raytrace)")
        ->type_name("NAME");
    cli_.add_option("--stats", stats_, "times, counters and warnings as JSON; times of one run, the first")
        ->type_name("FILE.json");
    cli_.add_option("--png", png_, "the beauty for eyes, exposed automatically")->type_name("FILE.png");
    cli_.add_option("--bits", bits_, "every pair's answer for the first light (penumbra-bits/1; mask methods)")
        ->type_name("FILE");
    auto* frame = cli_.add_option("--frame", frame_, "frame of the scene's animation")->type_name("F");
    cli_.add_option("--frames", frames_, "several frames, to OUT.0001.exr and so on")
        ->type_name("A-B")
        ->excludes(frame);
  }

  int run(const GlobalOptions& global) override {
    const auto method_options = parse_method_options(options_.method_options);
    if (!method_.empty()) describe_method(method_, method_options);  // refuses now what would be refused later
    const std::vector<std::filesystem::path> pictures = picture_paths();
    if (options_.out.extension() != ".exr") {
      throw UsageError("-o {}: expected a name that ends in .exr (--png writes a PNG file beside it)",
                       options_.out.string());
    }
    OutputFiles outputs;
    for (const std::filesystem::path& path : pictures) outputs.add("-o", path);
    outputs.add("--stats", stats_);
    outputs.add("--png", png_);
    outputs.add("--bits", bits_);
    outputs.refuse_inputs({&options_.scene, 1});
    outputs.require_writable();
    if (!png_.empty() && png_.extension() != ".png") {
      throw UsageError("--png {}: expected a name that ends in .png", png_.string());
    }

    Progress progress(!global.quiet);
    DeviceSource devices(options_.device);
    Session session = open_session(options_, devices, 0, progress);
    outputs.refuse_inputs(session.scene.sources);
    report_warnings(session, progress);
    const bool samples = !options_.light_samples.empty() || !options_.sample_pattern.empty() || !bits_.empty();
    const auto chosen = choose_light_methods(session.lights, {method_, method_options, samples});
    const std::vector<MethodLabel> labels = labels_of(chosen, devices, session.warnings);
    std::optional<BitsOutput> bits;
    if (!bits_.empty()) {
      check_bits(chosen.front().description, session.lights.front());
      bits.emplace(bits_, session, session.lights.front());
    }

    BeautyAccumulator beauty(session, session.lights);
    MethodRun result;
    for (const std::vector<std::size_t>& lights : same_methods(chosen)) {
      const LightMethod& with = chosen[lights.front()];
      const auto method = make_method(with.description.name, with.options, devices);
      add_run(result, run_method(
                          *method, session, {.lights = session.lights, .only = lights},
                          [&](const TileResult& tile) {
                            beauty.add(tile);
                            if (bits && tile.light == 0) bits->add(tile);
                          },
                          progress));
    }
    devices.check_validation();  // before anything appears: a picture that cannot be trusted is none

    progress.clear();
    for (const std::filesystem::path& path : pictures) {
      write_picture(path, session, {session.lights, labels}, result, beauty.pixels());
    }
    if (bits) bits->commit();
    if (!png_.empty()) {
      write_png(png_, to_srgb(session.width, session.height, beauty.pixels(), compare::auto_exposure(beauty.pixels())));
    }
    const compare::Stats stats = make_stats(session, {session.lights, labels}, result);
    if (!stats_.empty()) write_file_atomically(stats_, compare::json_text(compare::to_json(stats)));
    spdlog::info("{}", summary(stats));
    return 0;
  }

 private:
  /// Says, and notes, where light samples are looked at though nobody asked for them.
  static std::vector<MethodLabel> labels_of(const std::vector<LightMethod>& chosen, DeviceSource& devices,
                                            std::vector<std::string>& warnings) {
    std::vector<MethodLabel> labels;
    for (const LightMethod& one : chosen) {
      labels.push_back({one.description, one.options, device_of(one.description, devices.name())});
      if (one.note.empty()) continue;
      spdlog::info("{}", one.note);
      warnings.push_back(one.note);
    }
    return labels;
  }

  /// Scenes stand still so far: every frame shows the same, and is written all the same.
  [[nodiscard]] std::vector<std::filesystem::path> picture_paths() const {
    if (frames_.empty()) return {options_.out};
    std::vector<std::filesystem::path> paths;
    const FrameRange range = parse_frames(frames_);
    for (std::int64_t frame = range.first; frame <= range.last; ++frame)
      paths.push_back(frame_path(options_.out, frame));
    return paths;
  }

  void report_warnings(const Session& session, Progress& progress) const {
    progress.clear();
    for (const std::string& warning : session.warnings) spdlog::warn("{}", warning);
    if (frame_ || !frames_.empty()) spdlog::warn("{} has no animation: every frame shows the same", session.scene.name);
  }

  RunOptions options_;
  std::string method_;
  std::optional<std::int64_t> frame_;
  std::string frames_;
  std::filesystem::path stats_, png_, bits_;
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& app) {
  return std::make_unique<RenderCommand>(app);
}

}  // namespace penumbra::app
