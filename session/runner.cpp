// SPDX-License-Identifier: Apache-2.0
// Runs methods on sessions as often as a plan says, and takes medians of the times.

#include "session/runner.hpp"

#include "base/memory.hpp"
#include "session/method_host.hpp"
#include "session/process/stopwatch.hpp"
#include "visibility/changed_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace penumbra::session {
namespace {

/// Throws for a mesh that needs more memory with this method than this machine has, before it is allocated.
void require_mesh_memory(const visibility::MethodDescription& method, const visibility::SceneFloats& floats) {
  require_memory(floats.triangles.size() * method.bytes_per_triangle,
                 fmt::format("{} on {} triangles", method.name, floats.triangles.size()),
                 "make the meshes smaller, or choose another --method");
}

double sum_of(const OneRun& run, double LightTimes::*time) {
  return std::transform_reduce(run.lights.begin(), run.lights.end(), 0.0, std::plus(),
                               [&](const LightTimes& light) { return light.*time; });
}

}  // namespace

void add_run(MethodRun& to, MethodRun&& other) {
  if (to.visibility.empty()) {
    to = std::move(other);
    return;
  }
  to.times.mesh += other.times.mesh;
  to.times.light += other.times.light;
  to.times.evaluate += other.times.evaluate;
  to.times.view += other.times.view;
  to.times.read += other.times.read;
  to.times.total += other.times.total;
  for (std::size_t light = 0; light < to.visibility.size(); ++light) {
    if (other.visibility[light].empty()) continue;
    to.times.lights[light].light += other.times.lights[light].light;
    to.times.lights[light].evaluate += other.times.lights[light].evaluate;
    if (to.visibility[light].empty()) {
      to.visibility[light] = std::move(other.visibility[light]);
      continue;
    }
    for (std::size_t i = 0; i < to.visibility[light].size(); ++i) {
      if (std::isnan(to.visibility[light][i])) to.visibility[light][i] = other.visibility[light][i];
    }
  }
  to.passes.insert(to.passes.end(), other.passes.begin(), other.passes.end());
  for (const auto& [name, count] : other.counters) to.counters[name] += count;
  to.memory_bytes += other.memory_bytes;
}

MethodRun run_method(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
                     Progress& progress) {
  // Throws for unsupported lights before any work.
  const std::vector<std::size_t> chosen = chosen_lights(plan);
  for (const std::size_t light : chosen) visibility::check_light(method.description(), plan.lights[light]);

  if (plan.pixels) method.want_pixels(*plan.pixels);
  method.want_form_factors(plan.shades);

  const Stopwatch total;
  MethodRun result;
  result.visibility.resize(plan.lights.size());
  for (const std::size_t light : chosen) result.visibility[light].resize(session.pixel_count());
  const std::uint32_t discarded = plan.discard_first ? 1 : 0;
  progress.begin(plan.stage.empty() ? method.description().name : plan.stage,
                 std::uint64_t{session.height} * chosen.size() * (plan.runs + discarded));
  require_mesh_memory(method.description(), session.floats);

  MethodHost host(method, session, plan, sink, progress);
  std::vector<OneRun> runs;
  std::optional<OneRun> first;
  double elapsed = 0, latest = 0;  // of timed runs
  while (runs.empty() || (runs.size() < plan.runs && elapsed + latest <= plan.run_seconds)) {
    method.take_pass_times();  // discards those of earlier runs
    const bool is_first = !first && runs.empty(), is_discarded = is_first && plan.discard_first;
    const Stopwatch watch;
    OneRun times = host.run(is_first, is_discarded && std::isfinite(plan.most_seconds), result);
    latest = is_discarded ? 0 : watch.seconds();
    elapsed += latest;
    if (is_first) {
      result.times.mesh = times.mesh;  // later runs prepare meshes again only where lights' casters differ
      result.times.view = times.view;
      result.times.read = times.read;
    }
    if (is_discarded) {
      first = std::move(times);
    } else {
      runs.push_back(std::move(times));
    }
  }
  result.times.runs = static_cast<std::uint32_t>(runs.size());
  progress.advance(std::uint64_t{session.height} * chosen.size() * (plan.runs - runs.size()));
  const auto median_of = [&](const auto& time) {
    std::vector<double> seconds;
    for (const OneRun& run : runs) seconds.push_back(time(run));
    return median(std::move(seconds));
  };
  result.times.light = median_of([](const OneRun& run) { return sum_of(run, &LightTimes::light); });
  result.times.evaluate = median_of([](const OneRun& run) { return sum_of(run, &LightTimes::evaluate); });
  for (std::size_t light = 0; light < plan.lights.size(); ++light) {
    result.times.lights.push_back({median_of([&](const OneRun& run) { return run.lights[light].light; }),
                                   median_of([&](const OneRun& run) { return run.lights[light].evaluate; })});
  }
  if (first) {
    // A first run that happens to be faster than the median has no warm-up time.
    const double longer = sum_of(*first, &LightTimes::light) + sum_of(*first, &LightTimes::evaluate) -
                          result.times.light - result.times.evaluate - first->bands;
    result.times.warmup = std::max(longer, 0.0);
  }
  for (const auto& [name, count] : method.take_mesh_counters()) result.counters[name] += count;
  result.prepared = host.prepared();
  result.passes = method.take_pass_times();
  result.memory_bytes = method.memory_bytes();
  result.changed_defaults = visibility::changed_defaults(method);
  result.times.total = total.seconds();
  return result;
}

}  // namespace penumbra::session
