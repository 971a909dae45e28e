// SPDX-License-Identifier: Apache-2.0
// Options and runs that separate the causes of error that methods of several families share (docs/error-budget.md).

#include "visibility/method_repairs.hpp"

#include "base/assert.hpp"

#include <fmt/format.h>

#include <utility>

namespace penumbra::visibility {

MethodOptions options_with(const MethodDescription& method, const MethodOptions& given, const MethodOptions& more) {
  MethodOptions options = complete_options(method, given);
  for (const auto& [key, value] : more) options[key] = value;
  return options;
}

ErrorRepair inseparable(ErrorCause cause, std::string words) {
  return {.cause = cause, .words = std::move(words)};
}

ErrorRepair& repair_of(ErrorRepairs& repairs, ErrorCause cause) {
  ErrorRepair& repair = repairs.alone.at(static_cast<std::size_t>(cause));
  PENUMBRA_ASSERT(repair.cause == cause, "{} is in the place of {}", name_of(repair.cause), name_of(cause));
  return repair;
}

ErrorRepair parted_light(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = complete_options(method, given);
  return {.cause = ErrorCause::view,
          .end = RepairEnd::limit,
          .runs = {{method.name, options, 2}, {method.name, options, 4}},
          .words =
              "the light in 2 × 2 and 4 × 4 parts, with the scene seen from the centre of each, and the limit of both"};
}

ErrorRepair more_light_samples(const MethodDescription& method, const MethodOptions& given) {
  return {.cause = ErrorCause::samples,
          .runs = {{method.name, complete_options(method, given), 1, kRepairSamples}},
          .words = fmt::format("{} light samples", kRepairSamples)};
}

RepairRun visible_area() {
  return {"edge-scatter", {{"rows", "exact"}}};
}

ErrorRepairs no_repairs(const GeometryReasons& reasons) {
  ErrorRepairs repairs;
  repairs.alone = {inseparable(ErrorCause::resolution, reasons.resolution),
                   inseparable(ErrorCause::view, reasons.view),
                   inseparable(ErrorCause::layers, reasons.layers),
                   inseparable(ErrorCause::fusion, reasons.fusion),
                   inseparable(ErrorCause::gaps, reasons.gaps),
                   inseparable(ErrorCause::bias, reasons.bias),
                   inseparable(ErrorCause::samples, reasons.samples),
                   inseparable(ErrorCause::falloff, reasons.falloff)};
  repairs.together = {visible_area()};
  return repairs;
}

ErrorRepairs exact_pair_repairs(const MethodDescription& method, const MethodOptions& /*given*/) {
  if (method.gives_area()) return no_repairs({.samples = "V is the visible area itself, without light samples"});
  ErrorRepairs repairs = no_repairs({});
  repair_of(repairs, ErrorCause::samples) = {.cause = ErrorCause::samples,
                                             .runs = {visible_area()},
                                             .words = "infinitely many light samples: the visible area itself"};
  return repairs;
}

ErrorRepairs exact_centre_repairs(const MethodDescription& /*method*/, const MethodOptions& /*given*/) {
  ErrorRepairs repairs = no_repairs({.layers = "a point is hidden or not, by one surface or by many",
                                     .fusion = "a point is hidden or not: nothing is added up"});
  repair_of(repairs, ErrorCause::view) = {
      .cause = ErrorCause::view,
      .runs = {visible_area()},
      .words = "infinitely many sub-lights, each with the hard shadow of its own centre: the visible area itself"};
  return repairs;
}

}  // namespace penumbra::visibility
