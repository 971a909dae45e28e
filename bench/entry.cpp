// SPDX-License-Identifier: Apache-2.0
// Runs all contestants on one subject in turns and compares their results with the oracle (rays on the same samples).

#include "bench/entry.hpp"

#include "base/error.hpp"
#include "bench/cpu.hpp"
#include "bench/question.hpp"
#include "bench/runner.hpp"
#include "session/methods.hpp"
#include "session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace penumbra::bench {
namespace {

using visibility::SamplePattern;

session::MethodEntry oracle_entry() {
  session::MethodEntry entry;
  entry.label = entry.name = session::ray_judge().name;
  return entry;
}

/// Contestant and the kind of light samples given to it.
struct Rival {
  std::unique_ptr<Runner> runner;
  std::string name;
  bool jittered = false;
  bool adaptive = false;
  bool left_out = false;  ///< for the present question
};

/// All contestants of one subject.
class Field {
 public:
  Field(const Ground& ground, const Options& options)
      : ground_(ground), options_(options), oracle_(oracle_entry(), ground, ""), rays_(ground) {
    for (const session::MethodEntry& method : options.methods) {
      attempt(method.label, [&] {
        rivals_.push_back({std::make_unique<MethodRunner>(method, ground, options.device), method.label, false});
      });
    }
    add_peer({RayWork::all, false, name_of(RayWork::all)});
    for (const Peer& peer : options.peers) add_peer(peer);
  }

  std::vector<Contestant> answer(std::uint32_t samples, const ReferenceVisibility* reference);

 private:
  void add_peer(const Peer& peer) {
    rivals_.push_back(
        {std::make_unique<RayRunner>(peer, ground_, rays_), peer.name, peer.jittered, peer.work == RayWork::adaptive});
  }

  template <typename Work>
  static bool attempt(const std::string& name, const Work& work) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      fmt::print(stderr, "penumbra-bench: {} is left out: {}\n", name, error.what());
      return false;
    }
  }

  [[nodiscard]] Contestant judge(const Runner& runner, const Question& question,
                                 const ReferenceVisibility* reference) const;
  [[nodiscard]] bool may_run(const Runner& runner) const {
    return options_.budget <= 0 || runner.spent() < options_.budget;
  }

  const Ground& ground_;
  const Options& options_;
  MethodRunner oracle_;
  FastestRays rays_;
  std::vector<Rival> rivals_;
};

Contestant Field::judge(const Runner& runner, const Question& question, const ReferenceVisibility* reference) const {
  Contestant contestant = runner.result();
  if (&runner != &oracle_) {
    contestant.error = compare::visibility_error(runner.visibility(), question.truth, ground_.judged);
  }
  if (reference != nullptr) {
    contestant.error_to_reference =
        compare::visibility_error(runner.visibility(), reference->visibility, reference->pixels);
  }
  return contestant;
}

std::vector<Contestant> Field::answer(std::uint32_t samples, const ReferenceVisibility* reference) {
  const visibility::Light light = light_of(ground_, samples),
                          other = light_of(ground_, samples, SamplePattern::jittered);
  Question question{ground_, light, {}, {}}, jittered{ground_, other, {}, {}};
  if (std::ranges::any_of(rivals_, &Rival::jittered)) {
    oracle_.keep_masks(jittered.masks);
    oracle_.ask(jittered);
    oracle_.run(false);
    jittered.truth.assign(oracle_.visibility().begin(), oracle_.visibility().end());
    jittered.masks = {};
  }
  oracle_.keep_masks(question.masks);
  oracle_.ask(question);
  oracle_.run(false);
  question.truth.assign(oracle_.visibility().begin(), oracle_.visibility().end());

  const auto attempt_on = [&](Rival& rival, const auto& work) {
    if (!rival.left_out) rival.left_out = !attempt(rival.name, work);
  };
  std::vector<Rival*> running;
  for (Rival& rival : rivals_) {
    rival.left_out = rival.adaptive && samples <= AdaptiveRays::kFew;  // its first step would already use all samples
    attempt_on(rival, [&] {
      rival.runner->ask(rival.jittered ? jittered : question);
      rival.runner->run(false);
    });
  }
  for (std::uint32_t run = 0; run < options_.runs; ++run) {
    for (Rival& rival : rivals_) {
      if (may_run(*rival.runner)) attempt_on(rival, [&] { rival.runner->run(true); });
    }
    if (may_run(oracle_)) oracle_.run(true);
  }
  std::vector<Contestant> contestants;
  for (const Rival& rival : rivals_) {
    if (!rival.left_out) contestants.push_back(judge(*rival.runner, rival.jittered ? jittered : question, reference));
  }
  contestants.push_back(judge(oracle_, question, reference));
  return contestants;
}

}  // namespace

std::vector<double> Times::shadow() const {
  std::vector<double> sums;
  for (std::size_t i = 0; i < light.size(); ++i) sums.push_back(light[i] + evaluate[i]);
  return sums;
}

Timing timing_of(std::vector<double> seconds) {
  const auto [lowest, highest] = std::ranges::minmax(seconds);
  return {session::median(std::move(seconds)), lowest, highest};
}

const Contestant* find_contestant(const Entry& entry, const std::string& name) {
  const auto found = std::ranges::find(entry.contestants, name, &Contestant::name);
  return found == entry.contestants.end() ? nullptr : &*found;
}

void measure(const Subject& subject, const Options& options, const render::Machine& machine,
             const std::function<void(const Entry&)>& sink) {
  const Ground ground = make_ground(subject, machine);
  Field field(ground, options);
  std::optional<ReferenceVisibility> reference;
  if (!options.reference.empty()) reference = make_reference(ground, options, machine);
  for (const std::uint32_t samples : options.light_samples) {
    Entry entry;
    entry.subject = entry.name = subject.name;
    if (options.samples_in_name) entry.name += fmt::format("/n={}", samples);
    entry.triangles = ground.floats.triangles.size();
    entry.pixels = compare::pixels_with_alpha(ground.samples).size();
    entry.samples = light_of(ground, samples).sample_count();
    entry.width = entry.height = subject.size;
    entry.load_before = load_of_machine();
    if (reference) {
      entry.reference = reference->name;
      entry.reference_pixels = reference->pixels.size();
    }
    entry.contestants = field.answer(samples, reference ? &*reference : nullptr);
    sink(entry);
  }
}

}  // namespace penumbra::bench
