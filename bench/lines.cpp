#include "bench/lines.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Timing& timing) {
  return {
      {"median", timing.median}, {"lowest", timing.lowest}, {"highest", timing.highest}, {"spread", timing.spread()}};
}

double ratio_to_peer(const Entry& entry, const Contestant& contestant) {
  return timing_of(contestant.times.shadow()).median / timing_of(entry.contestants[1].times.shadow()).median;
}

std::string seconds(const Contestant& contestant) {
  const Timing timing = timing_of(contestant.times.shadow());
  return fmt::format("{:.3f} ±{:2.0f} %", timing.median, 50 * timing.spread());
}

}  // namespace

std::string table_head() {
  return fmt::format(
      "| {:<16} | {:>9} | {:>13} | {:>13} | {:>6} | {:>5} | {:>13} | {:>9} | {:>7} | {:>7} | {:>9} | {:>4} |\n"
      "| {:-<16} | {:->8}: | {:->12}: | {:->12}: | {:->5}: | {:->4}: | {:->12}: | {:->8}: | {:->6}: | {:->6}: | "
      "{:->8}: | {:->3}: |\n",
      "scene", "triangles", "view-sample s", "plain-rays s", "packet", "ratio", "raytrace s", "differing", "of all",
      "of pairs", "peer RMSE", "load", "", "", "", "", "", "", "", "", "", "", "", "");
}

std::string table_row(const Entry& entry) {
  const Contestant &ours = entry.contestants[0], &peer = entry.contestants[1], &raytrace = entry.contestants[2];
  const compare::PairCounts& pairs = *ours.pairs;
  const auto share = [&](std::uint64_t of) {
    return of == 0 ? 0.0 : static_cast<double>(pairs.differing) / static_cast<double>(of);
  };
  return fmt::format(
      "| {:<16} | {:>9} | {:>13} | {:>13} | {:>6} | {:>5.2f} | {:>13} | {:>9} | {:>7.1e} | {:>7.1e} | {:>9} | {:>4.1f} "
      "|\n",
      entry.subject, entry.triangles, seconds(ours), seconds(peer), entry.packet, ratio_to_peer(entry, ours),
      seconds(raytrace), pairs.differing, share(pairs.all), share(pairs.penumbra),
      peer.error ? fmt::format("{:.6f}", peer.error->rmse) : "-", entry.load_before);
}

std::string json_lines(const Entry& entry, const Options& options) {
  std::string lines;
  for (const Contestant& contestant : entry.contestants) {
    Json line{{"name", entry.subject + "/" + contestant.name},
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
              {"shadow", to_json(timing_of(contestant.times.shadow()))},
              {"ratioToPlainRays", ratio_to_peer(entry, contestant)}};
    if (contestant.name == "plain-rays") line["packet"] = entry.packet;
    if (contestant.error) {
      line["error"] = {
          {"rmse", contestant.error->rmse}, {"max", contestant.error->max}, {"bias", contestant.error->bias}};
    }
    if (contestant.pairs) {
      line["pairsAll"] = contestant.pairs->all;
      line["pairs"] = contestant.pairs->penumbra;
      line["pairsDiffering"] = contestant.pairs->differing;
    }
    if (!contestant.passes.empty()) line["passes"] = contestant.passes;
    if (!contestant.counters.empty()) line["counters"] = contestant.counters;
    lines += line.dump() + "\n";
  }
  return lines;
}

}  // namespace penumbra::bench
