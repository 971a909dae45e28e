// SPDX-License-Identifier: Apache-2.0
// Times whole pictures made by methods, and by a plain program on Embree.

#include "bench/whole_frame.hpp"

#include "app/process/terminal_progress.hpp"
#include "base/assert.hpp"
#include "base/error.hpp"
#include "bench/adaptive_rays.hpp"
#include "bench/cpu.hpp"
#include "bench/folder.hpp"
#include "bench/moved_light.hpp"
#include "reference/plain_rays.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/process/stopwatch.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

namespace penumbra::bench {
namespace {

using Seconds = std::map<std::string, double>;

/// Seconds of each phase of two frames; in the second the light has moved.
struct TwoFrames {
  Seconds first, second;
};

scenes::Scene with_light_moved(scenes::Scene scene) {
  scene.lights.front().shape = moved_light(scene.lights.front().shape);
  return scene;
}

/// Plain program on Embree.
class PlainProgram {
 public:
  PlainProgram(const scenes::Scene& scene, const scenes::Scene& next, const Subject& subject, std::uint32_t samples)
      : floats_(visibility::make_scene_floats(scene)),
        camera_(visibility::make_camera(scene.cameras.at(0), floats_.origin, subject.size, subject.size)),
        light_(light_with(scene, samples, subject.pattern)),
        next_light_(light_with(next, samples, subject.pattern)),
        adaptive_(light_with(scene, AdaptiveRays::kFew, subject.pattern)),
        next_adaptive_(light_with(next, AdaptiveRays::kFew, subject.pattern)) {
    double best = std::numeric_limits<double>::infinity();
    for (const int packet : {4, 8, 16}) {
      packet_ = packet;
      Seconds seconds = run().first;
      const double sum = seconds["view"] + seconds["evaluate"];
      if (sum < best) {
        best = sum;
        fastest_ = packet;
      }
    }
    packet_ = fastest_;
  }

  TwoFrames run() {
    const session::Stopwatch watch;
    reference::PlainRays rays({.width = packet_, .one_frame = true});
    rays.prepare_mesh(floats_);
    const double mesh = watch.seconds();
    TwoFrames seconds{look(rays, light_, adaptive_), look(rays, next_light_, next_adaptive_)};
    seconds.first["mesh"] = mesh;
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

  Seconds look(reference::PlainRays& rays, const visibility::Light& light, AdaptiveRays& adaptive) {
    Seconds seconds;
    const session::Stopwatch watch;
    visibility::ViewSamples samples = rays.look(camera_);
    seconds["view"] = watch.seconds();
    visibility_.resize(samples.size());
    const AdaptiveRays::Seconds spent = adaptive.run(rays, samples, light, visibility_);
    seconds["light"] = spent.light;
    seconds["evaluate"] = spent.evaluate;
    return seconds;
  }

  visibility::SceneFloats floats_;
  visibility::PinholeCamera camera_;
  visibility::Light light_, next_light_;
  AdaptiveRays adaptive_, next_adaptive_;
  std::vector<float> visibility_;
  int packet_ = 0, fastest_ = 0;
};

/// Method in `penumbra render`, from a scene in memory.
class MethodFrame {
 public:
  MethodFrame(const session::MethodEntry& method, const Subject& subject, std::uint32_t samples,
              const render::Machine& machine)
      : machine_(machine), wish_{method.name, method.options, true} {
    run_.scene = subject.name;
    run_.size = fmt::format("{0}x{0}", subject.size);
    run_.light_samples = std::to_string(samples);
    run_.sample_pattern = visibility::name_of(subject.pattern);
  }

  TwoFrames run(const scenes::Scene& scene, const scenes::Scene& next, const Folder& folder) {
    run_.lights = {scene.lights.front().name};
    app::TerminalProgress progress(false);
    session::FrameRenderer renderer(run_, wish_, machine_, progress);
    const auto stats_of = [&](const scenes::Scene& shown) {
      renderer.render(shown, {}, {}, 0);
      session::Exposure exposure;
      return renderer.write({.picture = folder / "a.exr", .stats = {}, .png = folder / "a.png", .bits = {}}, exposure);
    };
    const compare::Stats first = stats_of(scene), second = stats_of(next);
    PENUMBRA_ASSERT(second.counters.contains("meshesKept"), "{}: a light that moves leaves the mesh", wish_.method);
    return {phases_of(first.seconds), phases_of(second.seconds)};
  }

 private:
  static Seconds phases_of(const compare::Seconds& seconds) {
    return {{"floats", seconds.load.value_or(0)},       {"mesh", seconds.mesh.value_or(0)},
            {"view", seconds.view.value_or(0)},         {"light", seconds.light.value_or(0)},
            {"evaluate", seconds.evaluate.value_or(0)}, {"beauty", seconds.beauty.value_or(0)},
            {"write", seconds.write.value_or(0)}};
  }

  render::Machine machine_;
  session::MethodWish wish_;
  session::RunOptions run_;
};

void add_run(FrameTimes& times, const TwoFrames& seconds) {
  for (const auto& [phase, spent] : seconds.first) times.phases[phase].push_back(spent);
  for (const auto& [phase, spent] : seconds.second) times.next_phases[phase].push_back(spent);
}

void require_plain(const scenes::Scene& scene) {
  const auto casts = [](const scenes::Object& object) {
    return object.casts_shadow && object.alpha.mode == scenes::Alpha::Mode::opaque;
  };
  const auto is_of_the_light = [](const scenes::Object& object) { return object.emits == 0; };
  const bool in_pieces = std::holds_alternative<scenes::Pieces>(scene.lights.at(0).shape);
  if (std::ranges::all_of(scene.objects, casts) && std::ranges::none_of(scene.objects, is_of_the_light) && !in_pieces &&
      !scene.cameras.at(0).height)
    return;
  throw UsageError(
      "{}: --frame needs a perspective camera, meshes that all cast shadow, without holes, and a first light in one "
      "piece that is no mesh: the plain program has one hierarchy for all its rays",
      scene.name);
}

FrameEntry measure_one(const Subject& subject, const scenes::Scene& scene, const scenes::Scene& next,
                       std::uint32_t samples, const Options& options, const render::Machine& machine) {
  const Folder folder;
  FrameEntry entry;
  entry.subject = subject.name;
  entry.name = fmt::format("frame/{}/n={}", subject.name, samples);
  entry.triangles = scene.soup.triangles.size();
  entry.samples = samples;
  entry.size = subject.size;
  entry.load_before = load_of_machine();
  PlainProgram plain(scene, next, subject, samples);
  std::vector<MethodFrame> pictures;
  entry.contestants.push_back({"embree", {}, {}});
  for (const session::MethodEntry& method : options.methods) {
    pictures.emplace_back(method, subject, samples, machine);
    entry.contestants.push_back({method.label, {}, {}});
  }
  for (std::uint32_t run = 0; run <= options.runs; ++run) {
    const bool timed = run > 0;  // the first is discarded
    for (std::size_t i = 0; i < entry.contestants.size(); ++i) {
      const auto seconds = i == 0 ? plain.run() : pictures[i - 1].run(scene, next, folder);
      if (timed) add_run(entry.contestants[i], seconds);
    }
  }
  return entry;
}

}  // namespace

std::vector<double> FrameTimes::sum_of(const Phases& phases, const std::vector<std::string>& names) {
  std::vector<double> sums;
  for (const std::string& one : names) {
    const auto phase = phases.find(one);
    if (phase == phases.end()) continue;
    sums.resize(phase->second.size());
    for (std::size_t run = 0; run < sums.size(); ++run) sums[run] += phase->second[run];
  }
  return sums;
}

void measure_whole_frames(const Options& options, const render::Machine& machine,
                          const std::function<void(const FrameEntry&)>& sink) {
  for (const Subject& subject : options.subjects) {
    const scenes::Scene scene = read_subject(subject);
    require_plain(scene);
    const scenes::Scene next = with_light_moved(scene);
    for (const std::uint32_t samples : options.light_samples) {
      sink(measure_one(subject, scene, next, samples, options, machine));
    }
  }
}

}  // namespace penumbra::bench
