// SPDX-License-Identifier: Apache-2.0
// Options that separate the causes of error of three methods with one principle: patches of k layers whose fractions of
// the light are added (backproject; backproject-peel with all texels), or whose bits are joined (bitmask).

#include "maps/backprojection/patches/repairs.hpp"

#include "maps/backprojection/patches/methods.hpp"
#include "maps/host/error_repairs.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

using visibility::ErrorCause;
using visibility::ErrorRepair;
using visibility::ErrorRepairs;
using visibility::MethodDescription;
using visibility::MethodOptions;
using visibility::RepairEnd;
using visibility::RepairRun;

/// Returns `more`, and those of `options` that every method with patches has.
MethodOptions patch_options(const MethodOptions& options, const MethodOptions& more) {
  MethodOptions chosen = more;
  for (const char* key : {"size", "bias", "depth", "receiverPlane", "rasteriser"}) chosen.emplace(key, options.at(key));
  return chosen;
}

RepairRun joined(const MethodOptions& options, const MethodOptions& more) {
  MethodOptions patches = patch_options(options, more);
  patches["occluder"] = "patch";
  return {"bitmask", options_with(bitmask_description(), patches, {}), 1, kRepairSamples};
}

ErrorRepair union_of(const MethodOptions& options, const MethodOptions& more) {
  return {
      .cause = ErrorCause::fusion,
      .runs = {joined(options, more)},
      .words = fmt::format("the same patches joined, not added: bits of {} light samples (bitmask)", kRepairSamples)};
}

ErrorRepair shared_borders(RepairRun run) {
  return {.cause = ErrorCause::gaps,
          .runs = {std::move(run)},
          .words = "patches that end where their neighbours begin (fill=shared)"};
}

/// Returns the runs with every repair except that of the view, combined for patches: the finest union of all layers.
std::vector<RepairRun> patches_of_one_view(const MethodOptions& options) {
  const RepairRun run =
      joined(options,
             {{"layers", "16"}, {"fill", "shared"}, {"bias", "0.015625"}, {"depth", "first"}, {"receiverPlane", "on"}});
  const std::string doubled[] = {"size"};
  return from_finest(bitmask_description(), run, doubled);
}

}  // namespace

ErrorRepairs backproject_repairs(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = visibility::complete_options(method, given);
  ErrorRepairs repairs = map_repairs(method, given,
                                     {.ends_at_points = true,
                                      .fusion = "spheres are added, and no form of the method joins them",
                                      .gaps = "spheres reach beyond their texels: they only overlap"});
  repair_of(repairs, ErrorCause::layers) = more_layers(method, given);
  if (options.at("form") == "sphere") return repairs;
  repair_of(repairs, ErrorCause::fusion) = union_of(
      options, {{"layers", options.at("layers")}, {"fill", options.at("fill")}, {"search", options.at("search")}});
  repair_of(repairs, ErrorCause::gaps) =
      shared_borders({method.name, options_with(method, given, {{"fill", "shared"}})});
  repairs.one_view = patches_of_one_view(options);
  return repairs;
}

ErrorRepairs peel_repairs(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = visibility::complete_options(method, given);
  const std::string left_out = fmt::format(
      "no other method can leave out the same texels; samples=0 leaves out none (here {})", options.at("samples"));
  ErrorRepairs repairs = map_repairs(method, given, {.ends_at_points = true, .fusion = left_out, .gaps = left_out});
  repair_of(repairs, ErrorCause::layers) = more_layers(method, given);
  if (options.at("samples") != "0") {
    // With texels half as wide, the sampling step would be twice as large: the limit is set to all texels.
    ErrorRepair& resolution = repair_of(repairs, ErrorCause::resolution);
    for (RepairRun& run : resolution.runs)
      run.options.insert_or_assign("samples", std::string(1, '0'));  // g++ 12 warns of "0"
    resolution.runs.insert(resolution.runs.begin(), {method.name, options_with(method, given, {{"samples", "0"}})});
    resolution.words = "all texels, then texels half and a quarter as wide, and the limit of these runs";
  } else if (options.at("select") == "contribution") {
    const MethodOptions alike{{"layers", options.at("layers")}, {"search", "none"}};
    MethodOptions adding = patch_options(options, alike);
    adding["fill"] = "shared";
    repair_of(repairs, ErrorCause::fusion) = union_of(options, alike);
    repair_of(repairs, ErrorCause::gaps) =
        shared_borders({"backproject", options_with(backproject_description(), adding, {})});
  }
  repairs.one_view = patches_of_one_view(options);
  return repairs;
}

ErrorRepairs bitmask_repairs(const MethodDescription& method, const MethodOptions& given) {
  const MethodOptions options = visibility::complete_options(method, given);
  const bool patches = options.at("occluder") == "patch";
  ErrorRepairs repairs = map_repairs(
      method, given,
      {.ends_at_points = true,
       .fusion = "bits are joined: nothing is counted twice",
       .gaps = options.at("occluder") == "rect" ? "no form of the method fills the gaps between rectangles of blocks"
                                                : "its occluders share their corners: there are no gaps between them"});
  repair_of(repairs, ErrorCause::layers) = more_layers(method, given);
  if (patches) {
    repair_of(repairs, ErrorCause::gaps) = {
        .cause = ErrorCause::gaps,
        .runs = {{method.name, options_with(method, given, {{"fill", "diagonal"}})}},
        .words =
            "patches that extend to their neighbours, including the diagonal one (fill=diagonal); overlaps do no harm"};
  }
  for (RepairRun& run : repairs.one_view) {
    run.options["layers"] = "16";
    if (patches) run.options["fill"] = "diagonal";
  }
  return repairs;
}

ErrorRepairs layer_ray_repairs(const MethodDescription& method, const MethodOptions& given) {
  ErrorRepairs repairs = map_repairs(method, given,
                                     {.ends_at_points = true,
                                      .fusion = "rays are stopped or not: nothing is added",
                                      .gaps = "walls between neighbouring texels close gaps, but may also close real "
                                              "openings: no form of the method distinguishes the two"});
  repair_of(repairs, ErrorCause::layers) = more_layers(method, given);
  for (RepairRun& run : repairs.one_view) run.options["layers"] = "16";
  return repairs;
}

}  // namespace penumbra::maps
