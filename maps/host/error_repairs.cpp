// SPDX-License-Identifier: Apache-2.0
// Makes the runs that repair one cause of a map method's error at a time: resolution, view, bias, layers
// (docs/error-budget.md).

#include "maps/host/error_repairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace penumbra::maps {
namespace {

using visibility::ErrorCause;
using visibility::ErrorRepair;
using visibility::ErrorRepairs;
using visibility::MethodDescription;
using visibility::MethodOptions;
using visibility::RepairEnd;
using visibility::RepairRun;

/// Returns the options with some counts multiplied; nullopt if one of them would be too large.
std::optional<MethodOptions> multiplied(const MethodDescription& method, MethodOptions options,
                                        std::span<const std::string> counts, std::uint32_t factor) {
  for (const std::string& name : counts) {
    const auto option = std::ranges::find(method.options, name, &visibility::OptionDescription::name);
    std::string& text = options.at(name);
    const std::uint64_t count = factor * std::stoull(text);
    if (static_cast<double>(count) > option->most) return std::nullopt;
    text = std::to_string(count);
  }
  return options;
}

}  // namespace

ErrorRepair finer_maps(const MethodDescription& method, const MethodOptions& given,
                       std::span<const std::string> doubled) {
  const MethodOptions options = visibility::complete_options(method, given);
  ErrorRepair repair{.cause = ErrorCause::resolution,
                     .end = RepairEnd::limit,
                     .words = "texels half and a quarter as wide, and the limit of these runs"};
  for (const std::uint32_t factor : {2U, 4U}) {
    if (auto finer = multiplied(method, options, doubled, factor)) repair.runs.push_back({method.name, *finer});
  }
  if (repair.runs.empty()) repair.words = "its maps are as large as they can be";
  return repair;
}

ErrorRepair points_of_light(const MethodOptions& options) {
  MethodOptions alike;
  for (const char* key : {"size", "bias", "rasteriser"}) alike[key] = options.at(key);
  return {.cause = ErrorCause::view,
          .runs = {{"accumulate", alike, 1, kRepairSamples}},
          .words =
              fmt::format("infinitely many sub-lights: hard shadows of {} light samples (accumulate)", kRepairSamples)};
}

ErrorRepair more_layers(const MethodDescription& method, const MethodOptions& given) {
  MethodOptions options = visibility::complete_options(method, given);
  const std::string layers[] = {"layers"};
  ErrorRepair repair{.cause = ErrorCause::layers,
                     .end = RepairEnd::settled,
                     .words = "more layers of surfaces behind one another, until another layer changes nothing"};
  while (auto more = multiplied(method, options, layers, 2)) {
    options = *more;
    repair.runs.push_back({method.name, std::move(*more)});
  }
  if (repair.runs.empty()) repair.words = "it has as many layers as it can have";
  return repair;
}

std::vector<RepairRun> from_finest(const MethodDescription& method, const RepairRun& run,
                                   std::span<const std::string> doubled) {
  std::vector<RepairRun> runs;
  for (const std::uint32_t factor : {4U, 2U, 1U}) {
    RepairRun finer = run;
    auto options = multiplied(method, run.options, doubled, factor);
    if (!options) continue;
    finer.options = std::move(*options);
    runs.push_back(std::move(finer));
  }
  return runs;
}

ErrorRepairs map_repairs(const MethodDescription& method, const MethodOptions& given, const MapRepairs& repairs) {
  MethodOptions exact = repairs.bias;
  // Options that replace a bias also move the beginning of shadows.
  const auto has = [&](std::string_view name) {
    return std::ranges::find(method.options, name, &visibility::OptionDescription::name) != method.options.end();
  };
  const bool has_depth = has("depth");
  if (has_depth) exact["depth"] = "first";
  if (has("receiverPlane")) exact["receiverPlane"] = "on";
  const RepairRun best{method.name, options_with(method, given, exact)};
  ErrorRepair view = parted_light(method, given);
  if (repairs.ends_at_points) view = points_of_light(visibility::complete_options(method, given));
  if (!repairs.many_views.empty()) view = inseparable(ErrorCause::view, repairs.many_views);

  ErrorRepairs all;
  all.together = from_finest(method, best, repairs.doubled);
  if (!view.runs.empty()) {
    all.one_view = all.together;
    RepairRun views = best;
    views.light_parts = 4;
    if (repairs.ends_at_points) views = points_of_light(best.options).runs.front();
    all.together = from_finest(method, views, repairs.doubled);
  }
  all.alone = {finer_maps(method, given, repairs.doubled),
               std::move(view),
               inseparable(ErrorCause::layers, repairs.layers),
               inseparable(ErrorCause::fusion, repairs.fusion),
               inseparable(ErrorCause::gaps, repairs.gaps),
               {.cause = ErrorCause::bias,
                .runs = {best},
                .words = fmt::format("a bias of {} texels, just enough for rounding{}", exact.at("bias"),
                                     has_depth ? ", behind the nearest surface" : "")},
               method.counts_light_samples() ? visibility::more_light_samples(method, given)
                                             : inseparable(ErrorCause::samples, "it has no light samples"),
               inseparable(ErrorCause::falloff, repairs.falloff)};
  return all;
}

}  // namespace penumbra::maps
