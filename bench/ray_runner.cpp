// SPDX-License-Identifier: Apache-2.0
// Times ray casters on Embree.

#include "bench/runner.hpp"
#include "compare/machine.hpp"
#include "session/process/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace penumbra::bench {
namespace {

using visibility::ViewSamples;

}  // namespace

FastestRays::FastestRays(const Ground& ground) {
  const visibility::Light light = light_of(ground, 256);
  std::vector<float> visibility(ground.samples.size());
  double best = std::numeric_limits<double>::infinity();
  for (const int packet : {4, 8, 16}) {
    reference::PlainRays candidate({.width = packet});
    const session::Stopwatch watch;
    candidate.prepare_mesh(ground.floats);
    const double mesh = watch.seconds();
    candidate.prepare_light(light);
    candidate.evaluate(ground.samples, visibility);  // warms up
    const session::Stopwatch again;
    candidate.evaluate(ground.samples, visibility);
    if (again.seconds() >= best) continue;
    best = again.seconds();
    packet_ = packet;
    mesh_ = mesh;
    rays_.emplace(std::move(candidate));
  }
}

RayRunner::RayRunner(Peer peer, const Ground& ground, FastestRays& rays)
    : peer_(std::move(peer)),
      rays_(rays),
      chosen_(ground.samples),
      adaptive_(light_of(ground, AdaptiveRays::kFew,
                         peer_.jittered ? visibility::SamplePattern::jittered : visibility::SamplePattern::rows)) {}

void RayRunner::prepare(const Question& question) {
  chosen_.triangle = question.ground.samples.triangle;
  if (peer_.work == RayWork::nontrivial) {
    const std::vector<std::uint8_t> chosen = nontrivial_pixels(question);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (chosen[i] == 0) chosen_.triangle[i] = ViewSamples::kBackground;
    }
  }
  asked_ = static_cast<std::uint64_t>(std::ranges::count_if(
      chosen_.triangle, [](std::int32_t triangle) { return triangle != ViewSamples::kBackground; }));
}

Runner::Seconds RayRunner::run_once(const Question& question, std::vector<float>& visibility, bool /*timed*/) {
  if (peer_.work == RayWork::adaptive) {
    const AdaptiveRays::Seconds spent = adaptive_.run(rays_.rays(), chosen_, question.light, visibility);
    asked_ = adaptive_.asked();
    return {spent.light, spent.evaluate};
  }
  Seconds seconds;
  session::Stopwatch watch;
  rays_.rays().prepare_light(question.light);
  seconds.light = watch.seconds();
  watch.restart();
  rays_.rays().evaluate(chosen_, visibility);
  seconds.evaluate = watch.seconds();
  if (peer_.work == RayWork::nontrivial) {  // V of all other pixels is given, and takes no time
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      if (chosen_.triangle[i] == ViewSamples::kBackground) visibility[i] = question.truth[i];
    }
  }
  return seconds;
}

Contestant RayRunner::result() const {
  const compare::Machine machine = compare::this_machine();
  Contestant contestant;
  contestant.name = peer_.name;
  contestant.device = fmt::format("{}, {} threads", machine.processor, machine.threads);
  contestant.mesh = rays_.mesh_seconds();
  contestant.times = times();
  contestant.packet = rays_.packet();
  contestant.view_samples = asked_;
  return contestant;
}

}  // namespace penumbra::bench
