// SPDX-License-Identifier: Apache-2.0
// Formats times of whole frames as a table and JSON lines.

#include "bench/entry.hpp"
#include "bench/whole_frame.hpp"
#include "compare/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <utility>

namespace penumbra::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kFramePhases = {"floats", "mesh", "view", "light", "evaluate", "beauty", "write"};

Json timing_json(const std::vector<double>& seconds) {
  const Timing timing = timing_of(seconds);
  return {
      {"median", timing.median}, {"lowest", timing.lowest}, {"highest", timing.highest}, {"spread", timing.spread()}};
}

/// Returns the plain program's median divided by the contestant's: the factor by which the contestant is faster.
double times_faster(const std::vector<double>& plain, const std::vector<double>& seconds) {
  return timing_of(plain).median / timing_of(seconds).median;
}

std::string cell(const FrameTimes& times, const std::string& phase) {
  const auto found = times.phases.find(phase);
  return found == times.phases.end() ? "-" : fmt::format("{:.3f}", timing_of(found->second).median);
}

}  // namespace

std::string frame_table_head() {
  std::string head = fmt::format("| {:<52} |", "name"), rule = fmt::format("| {:-<52} |", "");
  for (const char* title : {"floats", "mesh", "view", "light", "eval.", "beauty", "write", "frame s", "± %", "faster",
                            "next", "mesh/E", "view/E", "load"}) {
    head += fmt::format(" {:>7} |", title);
    rule += " ------: |";
  }
  return head + "\n" + rule + "\n";
}

std::string frame_table_rows(const FrameEntry& entry) {
  std::string rows;
  const FrameTimes& plain = entry.contestants.front();
  for (const FrameTimes& times : entry.contestants) {
    rows += fmt::format("| {:<52} |", entry.name + "/" + times.name);
    for (const char* phase : kFramePhases) rows += fmt::format(" {:>7} |", cell(times, phase));
    const Timing frame = timing_of(times.frame());
    rows += fmt::format(
        " {:>7.3f} | {:>7.0f} | {:>7.3g} | {:>7.3g} | {:>7.3g} | {:>7.3g} | {:>7.1f} |\n", frame.median,
        50 * frame.spread(), times_faster(plain.frame(), times.frame()), times_faster(plain.next(), times.next()),
        1 / times_faster(FrameTimes::sum_of(plain.phases, {"mesh"}),
                         FrameTimes::sum_of(times.phases, {"floats", "mesh"})),
        1 / times_faster(FrameTimes::sum_of(plain.phases, {"view"}), FrameTimes::sum_of(times.phases, {"view"})),
        entry.load_before);
  }
  return rows;
}

std::string frame_json_lines(const FrameEntry& entry, const Options& options) {
  const compare::Machine machine = compare::this_machine();
  const FrameTimes& plain = entry.contestants.front();
  std::string lines;
  for (const FrameTimes& times : entry.contestants) {
    Json line{{"name", entry.name + "/" + times.name},
              {"commit", options.commit},
              {"buildType", PENUMBRA_BUILD_TYPE},
              {"device", fmt::format("{}, {} threads", machine.processor, machine.threads)},
              {"scene", entry.subject},
              {"method", times.name},
              {"triangles", entry.triangles},
              {"size", {entry.size, entry.size}},
              {"samples", entry.samples},
              {"runs", times.frame().size()},
              {"loadBefore", entry.load_before}};
    for (const char* phase : kFramePhases) {
      if (const auto found = times.phases.find(phase); found != times.phases.end())
        line["seconds"][phase] = timing_json(found->second);
    }
    for (const char* phase : kFramePhases) {
      if (const auto found = times.next_phases.find(phase); found != times.next_phases.end())
        line["nextSeconds"][phase] = timing_json(found->second);
    }
    line["frame"] = timing_json(times.frame());
    line["nextFrame"] = timing_json(times.next());
    line["timesFasterThanEmbree"] = times_faster(plain.frame(), times.frame());
    line["nextTimesFasterThanEmbree"] = times_faster(plain.next(), times.next());
    line["meshOverEmbreeBuild"] = 1 / times_faster(FrameTimes::sum_of(plain.phases, {"mesh"}),
                                                   FrameTimes::sum_of(times.phases, {"floats", "mesh"}));
    line["viewOverEmbreeRays"] =
        1 / times_faster(FrameTimes::sum_of(plain.phases, {"view"}), FrameTimes::sum_of(times.phases, {"view"}));
    lines += line.dump() + "\n";
  }
  return lines;
}

}  // namespace penumbra::bench
