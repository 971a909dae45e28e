#include "bench/whole_frame.hpp"

#include "app/pictures/frame_render.hpp"
#include "app/process/progress.hpp"
#include "app/process/stopwatch.hpp"
#include "base/error.hpp"
#include "bench/adaptive_rays.hpp"
#include "bench/cpu.hpp"
#include "bench/folder.hpp"
#include "reference/plain_rays.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra::bench {
namespace {

/// The program on Embree.
class PlainProgram {
 public:
  PlainProgram(const scenes::Scene& scene, const Subject& subject, std::uint32_t samples)
      : floats_(visibility::make_scene_floats(scene)),
        camera_(visibility::make_camera(scene.cameras.at(0), floats_.origin, subject.size, subject.size)),
        light_(light_with(scene, samples, subject.pattern)),
        adaptive_(light_with(scene, AdaptiveRays::kFew, subject.pattern)) {
    double best = std::numeric_limits<double>::infinity();
    for (const int packet : {4, 8, 16}) {
      packet_ = packet;
      std::map<std::string, double> seconds = run();
      const double sum = seconds["view"] + seconds["evaluate"];
      if (sum < best) {
        best = sum;
        fastest_ = packet;
      }
    }
    packet_ = fastest_;
  }

  std::map<std::string, double> run() {
    std::map<std::string, double> seconds;
    app::Stopwatch watch;
    reference::PlainRays rays({.width = packet_, .one_frame = true});
    rays.prepare_mesh(floats_);
    seconds["mesh"] = watch.seconds();
    watch.restart();
    visibility::ViewSamples samples = rays.look(camera_);
    seconds["view"] = watch.seconds();
    visibility_.resize(samples.size());
    const AdaptiveRays::Seconds spent = adaptive_.run(rays, samples, light_, visibility_);
    seconds["light"] = spent.light;
    seconds["evaluate"] = spent.evaluate;
    return seconds;
  }

 private:
  [[nodiscard]] visibility::Light light_with(const scenes::Scene& scene, std::uint32_t samples,
                                             visibility::SamplePattern pattern) const {
    visibility::SampleRequest request;
    request.count = samples;
    request.pattern = pattern;
    return visibility::make_light(scene, 0, floats_.origin, request);
  }

  visibility::SceneFloats floats_;
  visibility::PinholeCamera camera_;
  visibility::Light light_;
  AdaptiveRays adaptive_;
  std::vector<float> visibility_;
  int packet_ = 0, fastest_ = 0;
};

/// `penumbra render`, from a scene in memory.
class MethodFrame {
 public:
  MethodFrame(const app::MethodEntry& method, const Subject& subject, std::uint32_t samples, app::DeviceSource& devices)
      : devices_(devices), wish_{method.name, method.options, true} {
    run_.scene = subject.name;
    run_.size = fmt::format("{0}x{0}", subject.size);
    run_.light_samples = std::to_string(samples);
    run_.sample_pattern = visibility::name_of(subject.pattern);
  }

  std::map<std::string, double> run(const scenes::Scene& scene, const Folder& folder) {
    run_.lights = {scene.lights.front().name};
    app::Progress progress(false);
    app::FrameRenderer renderer(run_, wish_, devices_, progress);
    renderer.render(scene, {}, {}, 0);
    app::Exposure exposure;
    const compare::Seconds seconds =
        renderer.write({.picture = folder / "a.exr", .stats = {}, .png = folder / "a.png", .bits = {}}, exposure)
            .seconds;
    return {{"floats", seconds.load.value_or(0)},       {"mesh", seconds.mesh.value_or(0)},
            {"view", seconds.view.value_or(0)},         {"light", seconds.light.value_or(0)},
            {"evaluate", seconds.evaluate.value_or(0)}, {"beauty", seconds.beauty.value_or(0)},
            {"write", seconds.write.value_or(0)}};
  }

 private:
  app::DeviceSource& devices_;
  app::MethodWish wish_;
  app::RunOptions run_;
};

void add_run(FrameTimes& times, const std::map<std::string, double>& seconds) {
  for (const auto& [phase, spent] : seconds) times.phases[phase].push_back(spent);
}

void require_plain(const scenes::Scene& scene) {
  const auto casts = [](const scenes::Object& object) {
    return object.casts_shadow && object.alpha.mode == scenes::Alpha::Mode::opaque;
  };
  if (std::ranges::all_of(scene.objects, casts) && !scene.cameras.at(0).height) return;
  throw UsageError(
      "{}: --frame needs a perspective camera and meshes that all cast shadow, without holes: the plain program has "
      "one hierarchy for all its rays",
      scene.name);
}

FrameEntry measure_one(const Subject& subject, const scenes::Scene& scene, std::uint32_t samples,
                       const Options& options, app::DeviceSource& devices) {
  const Folder folder;
  FrameEntry entry;
  entry.subject = subject.name;
  entry.name = fmt::format("frame/{}/n={}", subject.name, samples);
  entry.triangles = scene.soup.triangles.size();
  entry.samples = samples;
  entry.size = subject.size;
  entry.load_before = load_of_machine();
  PlainProgram plain(scene, subject, samples);
  std::vector<MethodFrame> pictures;
  entry.contestants.push_back({"embree", {}});
  for (const app::MethodEntry& method : options.methods) {
    pictures.emplace_back(method, subject, samples, devices);
    entry.contestants.push_back({method.label, {}});
  }
  for (std::uint32_t run = 0; run <= options.runs; ++run) {
    const bool timed = run > 0;  // the first is discarded
    for (std::size_t i = 0; i < entry.contestants.size(); ++i) {
      const auto seconds = i == 0 ? plain.run() : pictures[i - 1].run(scene, folder);
      if (timed) add_run(entry.contestants[i], seconds);
    }
  }
  return entry;
}

}  // namespace

std::vector<double> FrameTimes::sum_of(const std::vector<std::string>& names) const {
  std::vector<double> sums;
  for (const std::string& one : names) {
    const auto phase = phases.find(one);
    if (phase == phases.end()) continue;
    sums.resize(phase->second.size());
    for (std::size_t run = 0; run < sums.size(); ++run) sums[run] += phase->second[run];
  }
  return sums;
}

std::vector<double> FrameTimes::frame() const {
  return sum_of({"floats", "mesh", "view", "light", "evaluate"});
}

std::vector<double> FrameTimes::next() const {
  return sum_of({"view", "light", "evaluate"});
}

void measure_whole_frames(const Options& options, app::DeviceSource& devices,
                          const std::function<void(const FrameEntry&)>& sink) {
  for (const Subject& subject : options.subjects) {
    const scenes::Scene scene = read_subject(subject);
    require_plain(scene);
    for (const std::uint32_t samples : options.light_samples) {
      sink(measure_one(subject, scene, samples, options, devices));
    }
  }
}

}  // namespace penumbra::bench
