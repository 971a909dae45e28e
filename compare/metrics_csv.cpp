// SPDX-License-Identifier: Apache-2.0
// Writes metrics.csv.

#include "compare/metrics_csv.hpp"

#include "base/csv.hpp"

#include <fmt/format.h>

namespace penumbra::compare {
namespace {

std::string joined_options(const visibility::MethodOptions& options) {
  std::string text;
  for (const auto& [key, value] : options) text += fmt::format("{}{}={}", text.empty() ? "" : ":", key, value);
  return text;
}

std::string error_fields(const std::optional<VisibilityError>& error) {
  std::string text;
  for (const auto part : {&VisibilityError::mean, &VisibilityError::rmse, &VisibilityError::p999, &VisibilityError::max,
                          &VisibilityError::over05, &VisibilityError::bias})
    text += "," + csv_field(error ? std::optional((*error).*part) : std::nullopt);
  return text;
}

std::string count_field(const std::optional<PairCounts>& pairs, std::uint64_t PairCounts::*count) {
  return pairs ? fmt::format("{}", (*pairs).*count) : "";
}

}  // namespace

std::string metrics_csv(const Metrics& metrics) {
  std::string csv =
      "entry,method,options,lightSamples,mean,rmse,p999,max,over05,bias,horizonRmse,allLightsRmse,pairsAll,"
      "pairsDiffering,flicker,meshSeconds,lightSeconds,evaluateSeconds,shadowSeconds,beautySeconds,runs,"
      "peakMemoryBytes,failure\r\n";
  const auto rmse_of = [](const std::optional<VisibilityError>& error) {
    return csv_field(error ? std::optional(error->rmse) : std::nullopt);
  };
  for (const MethodResult& result : metrics.methods) {
    const Seconds& seconds = result.stats.seconds;
    csv += fmt::format("{},{},{},{}{},{},{},{},{},{},", csv_field(result.entry), csv_field(result.stats.method),
                       csv_field(joined_options(result.stats.options)), result.stats.light_samples,
                       error_fields(result.error), rmse_of(result.horizon_error), rmse_of(result.all_lights_error),
                       count_field(result.pairs, &PairCounts::all), count_field(result.pairs, &PairCounts::differing),
                       csv_field(result.flicker));
    for (const auto& phase : {seconds.mesh, seconds.light, seconds.evaluate, seconds.shadow(), seconds.beauty})
      csv += csv_field(phase) + ",";
    csv += fmt::format("{},{},{}\r\n", result.stats.runs, result.stats.peak_memory_bytes,
                       csv_field(result.failure ? result.failure->message : ""));
  }
  return csv;
}

}  // namespace penumbra::compare
