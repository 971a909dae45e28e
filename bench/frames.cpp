// SPDX-License-Identifier: Apache-2.0
// Times the structures that a moved light needs in each frame: facings, silhouettes, wedges and lists, on host and
// device.

#include "bench/frames.hpp"

#include "session/process/stopwatch.hpp"
#include "session/session.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/raster/wedge_builder.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace penumbra::bench {
namespace {

using volumes::WedgeBuilder;
using volumes::WedgesOn;

constexpr std::uint32_t kFrames = 8;  // in one run

/// Returns the knot's light at positions on a circle around its original position.
std::vector<visibility::Light> lights_on_the_segment(const scenes::Scene& still, const glm::dvec3& origin) {
  scenes::Scene scene = still;
  std::vector<visibility::Light> lights;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    const double angle = 2 * std::numbers::pi * frame / kFrames;
    auto moved = std::get<scenes::Rectangle>(still.lights.at(0).shape);
    moved.center += glm::dvec3(std::cos(angle), 0.25 * std::sin(2 * angle), std::sin(angle));
    scene.lights[0].shape = moved;
    lights.push_back(visibility::make_light(scene, 0, origin, {}));
  }
  return lights;
}

/// Host or device, which run in turns.
struct Contender {
  Contender(const char* called, WedgesOn on, const render::Device& device, const visibility::SceneFloats& floats)
      : name(called), builder(device, {.on = on}) {
    builder.prepare_mesh(floats);
  }

  /// Returns the seconds of a frame; adds counts over the frames to the members below.
  double run(const std::vector<visibility::Light>& lights) {
    edges = edges_on_host = facings_on_host = 0;
    const session::Stopwatch watch;
    for (const visibility::Light& light : lights) {
      const WedgeBuilder::Built built = builder.build(light);
      edges += built.wedges.edges.size();
      edges_on_host += built.edges_on_host;
      facings_on_host += built.facings_on_host;
    }
    return watch.seconds() / static_cast<double>(lights.size());
  }

  const char* name;
  WedgeBuilder builder;
  std::vector<double> seconds;
  std::uint64_t edges = 0, edges_on_host = 0, facings_on_host = 0;
};

}  // namespace

void measure_frames(const Options& options, const render::Device& device,
                    const std::function<void(const CpuEntry&)>& sink) {
  for (const std::uint64_t triangles : options.triangles) {
    const scenes::Scene scene = knot_scene(triangles);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const std::vector<visibility::Light> lights = lights_on_the_segment(scene, floats.origin);
    std::array contenders = {Contender("host", WedgesOn::host, device, floats),
                             Contender("device", WedgesOn::device, device, floats)};
    const double load = load_of_machine();
    for (std::uint32_t run = 0; run <= options.runs; ++run) {
      for (Contender& contender : contenders) {
        const double seconds = contender.run(lights);
        if (run > 0) contender.seconds.push_back(seconds);  // the first is discarded
      }
      if (contenders[0].edges != contenders[1].edges) {
        throw std::logic_error(fmt::format("{} and {} silhouettes", contenders[0].edges, contenders[1].edges));
      }
    }
    const auto frames = static_cast<double>(options.runs + 1) * kFrames;
    for (Contender& contender : contenders) {
      CpuEntry entry;
      entry.name = fmt::format("wedges-per-frame/{}/triangles={}", contender.name, triangles);
      if (&contender == &contenders[1]) {
        entry.device = device.info().name;
        entry.host_ratio = session::median(contenders[0].seconds) / session::median(contender.seconds);
      }
      entry.triangles = floats.triangles.size();
      entry.items = entry.edges = contender.edges / lights.size();
      entry.seconds = contender.seconds;
      entry.counts = {{"edgesOnHost", contender.edges_on_host / kFrames},
                      {"facingsOnHost", contender.facings_on_host / kFrames}};
      for (const auto& pass : contender.builder.take_pass_times()) entry.passes[pass.name] = pass.milliseconds / frames;
      entry.load_before = load;
      sink(entry);
    }
  }
}

}  // namespace penumbra::bench
