// SPDX-License-Identifier: Apache-2.0
// Formats results as tables and JSON lines.

#include "bench/lines.hpp"

#include "compare/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Timing& timing) {
  return {
      {"median", timing.median}, {"lowest", timing.lowest}, {"highest", timing.highest}, {"spread", timing.spread()}};
}

Json to_json(const compare::VisibilityError& error) {
  return {{"rmse", error.rmse}, {"max", error.max},   {"bias", error.bias},
          {"mean", error.mean}, {"p999", error.p999}, {"over05", error.over05}};
}

/// Returns the contestant's seconds divided by those of a peer; nullopt if the peer did not run.
std::optional<double> ratio_to(const Entry& entry, const std::string& peer, const Contestant& contestant) {
  const Contestant* other = find_contestant(entry, peer);
  if (other == nullptr) return std::nullopt;
  return timing_of(contestant.times.shadow()).median / timing_of(other->times.shadow()).median;
}

std::string seconds(const Timing& timing) {
  return fmt::format("{:.4g} ±{:2.0f} %", timing.median, 50 * timing.spread());
}

std::string ratio_text(std::optional<double> ratio) {
  return ratio ? fmt::format("{:.3g}", *ratio) : "-";
}

std::string rmse_text(const std::optional<compare::VisibilityError>& error) {
  return error ? fmt::format("{:.2e}", error->rmse) : "-";
}

void add_errors(Json& line, const Entry& entry, const Contestant& contestant) {
  if (contestant.error) line["error"] = to_json(*contestant.error);
  if (contestant.error_to_reference) {
    line["errorToReference"] = to_json(*contestant.error_to_reference);
    line["errorToReference"]["reference"] = entry.reference;
    line["errorToReference"]["pixels"] = entry.reference_pixels;
  }
  if (contestant.pairs) {
    line["pairsAll"] = contestant.pairs->all;
    line["pairs"] = contestant.pairs->penumbra;
    line["pairsDiffering"] = contestant.pairs->differing;
  }
}

}  // namespace

std::string table_head(bool penumbra) {
  return fmt::format(
      "| {:<50} | {:>15} | {:>7} | {:>7} | {:>7} | {:>9} | {:>9} | {:>9} | {:>7} | {:>6} | {:>4} |\n"
      "| {:-<50} | {:->14}: | {:->6}: | {:->6}: | {:->6}: | {:->8}: | {:->8}: | {:->8}: | {:->6}: | {:->5}: | {:->3}: "
      "|\n",
      "name", "shadow s", "plain", "nontr.", "adapt.", "RMSE s.l.", penumbra ? "RMSE pen." : "RMSE", "differing",
      "of all", "MiB", "load", "", "", "", "", "", "", "", "", "", "", "");
}

std::string table_rows(const Entry& entry) {
  std::string rows;
  for (const Contestant& contestant : entry.contestants) {
    std::string differing = "-", share = "-";
    if (contestant.pairs) {
      const auto of = static_cast<double>(contestant.pairs->all);
      differing = std::to_string(contestant.pairs->differing);
      share = fmt::format("{:.1e}", of > 0 ? static_cast<double>(contestant.pairs->differing) / of : 0.0);
    }
    rows += fmt::format(
        "| {:<50} | {:>15} | {:>7} | {:>7} | {:>7} | {:>9} | {:>9} | {:>9} | {:>7} | {:>6} | {:>4.1f} |\n",
        entry.name + "/" + contestant.name, seconds(timing_of(contestant.times.shadow())),
        ratio_text(ratio_to(entry, "plain-rays", contestant)),
        ratio_text(ratio_to(entry, "nontrivial-rays", contestant)),
        ratio_text(ratio_to(entry, "adaptive-rays", contestant)), rmse_text(contestant.error),
        rmse_text(contestant.error_to_reference), differing, share,
        contestant.memory ? std::to_string((*contestant.memory + (1U << 19)) >> 20) : "-", entry.load_before);
  }
  return rows;
}

std::string json_lines(const Entry& entry, const Options& options) {
  std::string lines;
  for (const Contestant& contestant : entry.contestants) {
    Json line{{"name", entry.name + "/" + contestant.name},
              {"commit", options.commit},
              {"buildType", PENUMBRA_BUILD_TYPE},
              {"device", contestant.device},
              {"scene", entry.subject},
              {"method", contestant.name},
              {"triangles", entry.triangles},
              {"size", {entry.width, entry.height}},
              {"pixels", entry.pixels},
              {"samples", entry.samples},
              {"runs", contestant.times.light.size()},
              {"loadBefore", entry.load_before},
              {"mesh", contestant.mesh},
              {"light", to_json(timing_of(contestant.times.light))},
              {"evaluate", to_json(timing_of(contestant.times.evaluate))},
              {"shadow", to_json(timing_of(contestant.times.shadow()))}};
    for (const auto& [key, peer] : {std::pair{"ratioToPlainRays", "plain-rays"},
                                    {"ratioToNontrivialRays", "nontrivial-rays"},
                                    {"ratioToAdaptiveRays", "adaptive-rays"}}) {
      if (const auto ratio = ratio_to(entry, peer, contestant)) line[key] = *ratio;
    }
    if (contestant.packet != 0) {
      line["packet"] = contestant.packet;
      line["viewSamples"] = contestant.view_samples;
    }
    add_errors(line, entry, contestant);
    if (contestant.memory) line["memoryBytes"] = *contestant.memory;
    if (!contestant.passes.empty()) line["passes"] = contestant.passes;
    if (!contestant.counters.empty()) line["counters"] = contestant.counters;
    lines += line.dump() + "\n";
  }
  return lines;
}

std::string cpu_table_head() {
  return fmt::format(
      "| {:<44} | {:>14} | {:>11} | {:>7} | {:>9} |\n| {:-<44} | {:->13}: | {:->10}: | {:->6}: | {:->8}: |\n", "name",
      "seconds", "a second", "growth", "host / it", "", "", "", "", "");
}

std::string cpu_table_row(const CpuEntry& entry) {
  const Timing timing = timing_of(entry.seconds);
  return fmt::format("| {:<44} | {:>14} | {:>11.4g} | {:>7} | {:>9} |\n", entry.name, seconds(timing),
                     static_cast<double>(entry.items) / timing.median, ratio_text(entry.growth),
                     ratio_text(entry.host_ratio));
}

std::string json_line(const CpuEntry& entry, const Options& options) {
  const compare::Machine machine = compare::this_machine();
  const std::string processor = fmt::format("{}, {} threads", machine.processor, machine.threads);
  const Timing timing = timing_of(entry.seconds);
  Json line{{"name", entry.name},
            {"commit", options.commit},
            {"buildType", PENUMBRA_BUILD_TYPE},
            {"device", entry.device.empty() ? processor : entry.device},
            {"triangles", entry.triangles},
            {"edges", entry.edges},
            {"items", entry.items},
            {"runs", entry.seconds.size()},
            {"loadBefore", entry.load_before},
            {"seconds", to_json(timing)},
            {"itemsPerSecond", static_cast<double>(entry.items) / timing.median}};
  if (entry.growth) line["growth"] = *entry.growth;
  if (entry.host_ratio) line["hostRatio"] = *entry.host_ratio;
  if (!entry.counts.empty()) line["counters"] = entry.counts;
  if (!entry.passes.empty()) line["passes"] = entry.passes;
  return line.dump() + "\n";
}

}  // namespace penumbra::bench
