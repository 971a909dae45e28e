// SPDX-License-Identifier: Apache-2.0
// Runs that separate the causes of error of soft shadow volumes: silhouettes of the light's centre, one layer, sums in
// place of unions, ramps in place of areas (docs/error-budget.md).

#include "volumes/soft/repairs.hpp"

#include "visibility/method_repairs.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::ErrorCause;
using visibility::ErrorRepair;
using visibility::ErrorRepairs;
using visibility::kRepairSamples;
using visibility::MethodDescription;
using visibility::MethodOptions;
using visibility::repair_of;
using visibility::RepairRun;

/// Form of soft-irregular with all layers, in `parts` × `parts` parts of the light.
struct Form {
  const char* silhouettes = "centre";
  const char* fusion = "sum";
  std::uint32_t parts = 1;
};
RepairRun run_of(const Form& form) {
  const bool joined = std::string(form.fusion) == "union";
  // arc=tangent keeps the digits of small angles, so that no part of the error is due to the arc cosine.
  return {"soft-irregular",
          {{"arc", "tangent"}, {"fusion", form.fusion}, {"silhouettes", form.silhouettes}, {"umbra", "layers"}},
          form.parts,
          joined ? kRepairSamples : 0};
}

ErrorRepair own_silhouettes(const Form& form) {
  return {.cause = ErrorCause::view,
          .runs = {run_of(form)},
          .words = "the silhouettes that each view sample sees, not the light's centre (soft-irregular)"};
}

ErrorRepair unions(const Form& form) {
  return {.cause = ErrorCause::fusion,
          .runs = {run_of(form)},
          .words = fmt::format(
              "the union of the same layers, instead of their sum: {} light samples (soft-irregular:fusion=union)",
              kRepairSamples)};
}

/// Returns the repairs of sums over silhouettes of the centre, in parts of the light.
ErrorRepairs sum_repairs(std::uint32_t parts) {
  ErrorRepairs repairs = visibility::no_repairs({});
  repair_of(repairs, ErrorCause::view) = own_silhouettes({.silhouettes = "receiver", .parts = parts});
  repair_of(repairs, ErrorCause::fusion) = unions({.fusion = "union", .parts = parts});
  repairs.one_view = {run_of({.fusion = "union", .parts = parts})};
  repairs.together = {run_of({.silhouettes = "receiver", .fusion = "union", .parts = parts})};
  return repairs;
}

}  // namespace

ErrorRepairs soft_volume_repairs(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = visibility::complete_options(method, given);
  const auto parts = static_cast<std::uint32_t>(std::stoul(options.at("split")));
  ErrorRepairs repairs = sum_repairs(parts);
  const std::string& fusion = options.at("fusion");
  const bool table = options.at("coverage") == "table", floats = options.at("as") == "published" || fusion == "vote";
  if (table) {
    repair_of(repairs, ErrorCause::resolution) = {
        .cause = ErrorCause::resolution,
        .runs = {{method.name, visibility::options_with(method, given, {{"coverage", "analytic"}})}},
        .words = "the light beyond each edge integrated, not looked up in a table (coverage=analytic)"};
  }
  if (fusion == "max" || fusion == "product" || fusion == "average") {
    ErrorRepair parted = visibility::parted_light(method, given);
    for (RepairRun& run : parted.runs) {  // divides the parts that the method already has
      run.light_parts *= parts;
      run.options.insert_or_assign("split", std::string(1, '1'));  // g++ 12 warns of "1"
    }
    repair_of(repairs, ErrorCause::view) = std::move(parted);
  }
  if (table || floats) {
    // The run that repairs these has neither a table nor sides by floats, so it would repair two causes at once.
    const char* words = table ? "only with coverage=analytic: the repair has no table"
                              : "only with as=repaired and without votes: the repair decides sides by exact signs";
    repair_of(repairs, ErrorCause::view) = visibility::inseparable(ErrorCause::view, words);
    repair_of(repairs, ErrorCause::fusion) = visibility::inseparable(ErrorCause::fusion, words);
  }
  return repairs;
}

ErrorRepairs soft_irregular_repairs(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = visibility::complete_options(method, given);
  const bool centre = options.at("silhouettes") == "centre", layers = options.at("umbra") == "layers";
  const auto with = [&](const char* key, const char* value) {
    return RepairRun{method.name, visibility::options_with(method, given, {{key, value}})};
  };
  ErrorRepairs repairs = sum_repairs(1);
  if (centre) {
    repair_of(repairs, ErrorCause::view).runs = {with("silhouettes", "receiver")};
  } else {
    repair_of(repairs, ErrorCause::view) =
        visibility::inseparable(ErrorCause::view, "each view sample already uses the silhouettes that it sees");
    repairs.one_view.clear();
  }
  if (!layers) {
    repair_of(repairs, ErrorCause::layers) = {.cause = ErrorCause::layers,
                                              .runs = {with("umbra", "layers")},
                                              .words = "all layers that hide the light's centre (umbra=layers)"};
    repair_of(repairs, ErrorCause::fusion) = visibility::inseparable(
        ErrorCause::fusion,
        "only with umbra=layers: the map has one layer, and the others, which it does not store, cannot be joined");
  } else if (options.at("fusion") == "union") {
    repair_of(repairs, ErrorCause::fusion) =
        visibility::inseparable(ErrorCause::fusion, "a part of the light that several triangles hide counts once");
    repair_of(repairs, ErrorCause::samples) = visibility::more_light_samples(method, given);
  } else {
    RepairRun joined = with("fusion", "union");
    joined.light_samples = kRepairSamples;
    repair_of(repairs, ErrorCause::fusion).runs = {std::move(joined)};
  }
  return repairs;
}

ErrorRepairs soft_volume_blend_repairs(const MethodDescription& method, const MethodOptions& given) {
  ErrorRepairs repairs = sum_repairs(1);
  ErrorRepair& view = repair_of(repairs, ErrorCause::view);
  view = visibility::parted_light(method, given);
  view.words += "; boxes get better with it";
  repair_of(repairs, ErrorCause::fusion).words = fmt::format(
      "the union of all layers, instead of objects combined by their boxes: {} light samples "
      "(soft-irregular:fusion=union)",
      kRepairSamples);
  return repairs;
}

ErrorRepairs wedge_ramp_repairs(const MethodDescription& method, const MethodOptions& given) {
  ErrorRepairs repairs = sum_repairs(1);
  ErrorRepair& view = repair_of(repairs, ErrorCause::view);
  view = visibility::parted_light(method, given);
  view.words += "; this shortens the ramps";
  repair_of(repairs, ErrorCause::fusion) = visibility::inseparable(
      ErrorCause::fusion, "a ramp does not say which region of the light is hidden, so no regions can be joined");
  repair_of(repairs, ErrorCause::falloff) = {
      .cause = ErrorCause::falloff,
      .runs = {{"soft-volume", {}}},
      .words = "the light's area beyond each edge instead of a linear ramp (soft-volume)"};
  return repairs;
}

ErrorRepairs plateaus_repairs(const MethodDescription& method, const MethodOptions& given) {
  ErrorRepairs repairs =
      visibility::no_repairs({.layers = "only whether the light's centre is hidden matters, not by how many surfaces",
                              .fusion = "only the darkest edge counts, so nothing is added or joined",
                              .falloff = "penumbrae around a complete hard shadow have no equivalent with areas"});
  ErrorRepair& view = repair_of(repairs, ErrorCause::view);
  view = visibility::parted_light(method, given);
  view.words += "; this narrows the penumbrae";
  return repairs;
}

}  // namespace penumbra::volumes
