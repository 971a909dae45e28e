// SPDX-License-Identifier: Apache-2.0
// Runs and times one method of the program.

#include "bench/runner.hpp"
#include "compare/machine.hpp"
#include "compare/metrics.hpp"
#include "session/methods.hpp"
#include "session/process/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace penumbra::bench {
namespace {

using visibility::PixelClass;

/// Counts pairs over a tile's pixels with A = 1. Emitters and surfaces that receive no shadow are visible by the host's
/// rule, whatever a method computes for them: their pairs are counted as equal.
compare::PairCounts count_pairs(const Question& question, const visibility::Tile& tile,
                                std::span<const std::uint32_t> masks) {
  const std::size_t width = question.ground.samples.width, first = tile.first_row * width;
  std::vector<std::uint32_t> asked;  // relative to the tile
  std::uint64_t by_rule = 0;
  for (std::uint32_t i = 0; i < tile.row_count * width; ++i) {
    const PixelClass c = question.ground.classes[first + i];
    if (c == PixelClass::background) continue;
    if (c == PixelClass::emitter || c == PixelClass::unshadowed) {
      ++by_rule;
    } else {
      asked.push_back(i);
    }
  }
  const std::uint32_t samples = question.light.sample_count();
  const auto reference = std::span(question.masks).subspan(first * question.light.words_per_mask(), masks.size());
  compare::PairCounts counts =
      compare::count_pairs({.method = masks, .reference = reference, .sample_count = samples}, asked);
  counts.all += by_rule * samples;
  return counts;
}

}  // namespace

void Runner::ask(const Question& question) {
  question_ = &question;
  times_ = {};
  visibility_.assign(question.ground.samples.size(), 1);
  prepare(question);
}

void Runner::run(bool timed) {
  const Seconds seconds = run_once(*question_, visibility_, timed);
  if (!timed) return;
  times_.light.push_back(seconds.light);
  times_.evaluate.push_back(seconds.evaluate);
}

double Runner::spent() const {
  const std::vector<double> sums = times_.shadow();
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

MethodRunner::MethodRunner(const session::MethodEntry& entry, const Ground& ground, const std::string& device)
    : entry_(entry),
      machine_(session::make_machine(device)),
      method_(session::make_method(entry.name, entry.options, machine_)) {
  const session::Stopwatch watch;
  method_->prepare_mesh(ground.floats);
  mesh_ = watch.seconds();
}

void MethodRunner::prepare(const Question& question) {
  const compare::Machine machine = compare::this_machine();
  where_ = session::runs_on_device(entry_.name, entry_.options, question.light, machine_)
               ? machine_.device_name()
               : fmt::format("{}, {} threads", machine.processor, machine.threads);
  passes_.clear();
  pairs_.reset();
}

void MethodRunner::take_masks(const Question& question, const visibility::Tile& tile) {
  std::vector<std::uint32_t> masks(std::size_t{tile.row_count} * question.ground.samples.width *
                                   question.light.words_per_mask());
  method_->read_masks(masks);
  if (kept_ != nullptr) {
    kept_->insert(kept_->end(), masks.begin(), masks.end());
  } else {
    if (!pairs_) pairs_.emplace();
    *pairs_ += count_pairs(question, tile, masks);
  }
}

Runner::Seconds MethodRunner::run_once(const Question& question, std::vector<float>& visibility, bool timed) {
  Seconds seconds;
  session::Stopwatch watch;
  method_->prepare_light(question.light);
  seconds.light = watch.seconds();
  method_->prepare_view(question.ground.samples);  // shared by all methods, therefore not part of any method's time
  method_->take_pass_times();
  const std::uint32_t step = method_->max_tile_rows(), height = question.ground.samples.height;
  const std::size_t width = question.ground.samples.width;
  const bool has_masks = method_->description().output == visibility::Output::mask;
  if (kept_ != nullptr && !timed) kept_->clear();
  for (std::uint32_t row = 0; row < height; row += step) {
    const visibility::Tile tile{row, std::min(step, height - row)};
    watch.restart();
    method_->evaluate(tile);
    seconds.evaluate += watch.seconds();
    method_->read_visibility(std::span(visibility).subspan(row * width, tile.row_count * width));
    if (has_masks && !timed) take_masks(question, tile);
  }
  passes_ = method_->take_pass_times();
  return seconds;
}

Contestant MethodRunner::result() const {
  machine_.check_validation();
  Contestant contestant;
  contestant.name = entry_.label;
  contestant.device = where_;
  contestant.mesh = mesh_;
  contestant.times = times();
  contestant.pairs = pairs_;
  for (const visibility::PassTime& pass : passes_) contestant.passes[pass.name] += pass.milliseconds;
  contestant.counters = method_->counters();
  contestant.memory = method_->memory_bytes();
  return contestant;
}

}  // namespace penumbra::bench
