// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method_repairs.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Repairs of the causes of error common to methods of this family: docs/error-budget.md. Throughout, `given` are the
/// options of the run to be explained.
namespace penumbra::maps {

using visibility::inseparable;
using visibility::kRepairSamples;
using visibility::options_with;
using visibility::parted_light;
using visibility::repair_of;

/// Returns the repair of resolution: texels half and a quarter as wide; `doubled` are the options that determine the
/// number of texels.
visibility::ErrorRepair finer_maps(const visibility::MethodDescription& method, const visibility::MethodOptions& given,
                                   std::span<const std::string> doubled);

/// Returns the repair of view by a map from each of kRepairSamples light samples. Valid for methods whose shadow of a
/// point light is that of a shadow map: as sub-lights shrink, such a method converges to this repair.
visibility::ErrorRepair points_of_light(const visibility::MethodOptions& options);

/// Returns the repair of layers: the option `layers` doubled, up to the largest value.
visibility::ErrorRepair more_layers(const visibility::MethodDescription& method,
                                    const visibility::MethodOptions& given);

/// Differences between the methods of this family when their error is separated.
struct MapRepairs {
  std::vector<std::string> doubled = {"size"};      ///< see finer_maps
  bool ends_at_points = false;                      ///< points_of_light, not parted_light
  std::string many_views = {};                      ///< reason why `view` cannot be separated; empty: separable
  std::string layers = {}, fusion = {}, gaps = {};  ///< reasons why these causes cannot be separated
  std::string falloff =
      "V follows from the contents of texels, not from a formula of a distance that has alternative forms";
  /// Options that distinguish a caster from the receiver's own surface with no tolerance beyond rounding.
  visibility::MethodOptions bias = {{"bias", "0.015625"}};
};

/// Returns the repairs of resolution, view, bias and, if the method has any, light samples, and of the first three
/// together; the other causes are inseparable for the given reasons.
visibility::ErrorRepairs map_repairs(const visibility::MethodDescription& method,
                                     const visibility::MethodOptions& given, const MapRepairs& repairs);

/// Returns `run` with texels a quarter as wide, half as wide, and unchanged: the remaining error of each.
std::vector<visibility::RepairRun> from_finest(const visibility::MethodDescription& method,
                                               const visibility::RepairRun& run, std::span<const std::string> doubled);

}  // namespace penumbra::maps
