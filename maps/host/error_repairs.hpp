#pragma once

#include "visibility/error_repair.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// What repairs the causes of error that methods of this family share: docs/error-budget.md. In all of this `given` are
/// the options of the run that is to be explained, and `more` those that a repair needs besides.
namespace penumbra::maps {

/// All of a method's options as given, some in other words.
visibility::MethodOptions options_with(const visibility::MethodDescription& method,
                                       const visibility::MethodOptions& given, const visibility::MethodOptions& more);

/// Nothing separates this cause; `words` say why.
visibility::ErrorRepair inseparable(visibility::ErrorCause cause, std::string words);

/// Resolution: texels half and a quarter as wide; `doubled` are the options that say how many there are.
visibility::ErrorRepair finer_maps(const visibility::MethodDescription& method, const visibility::MethodOptions& given,
                                   std::span<const std::string> doubled);

/// So many light samples stand for all of the light: V of them is off by about 0.0025 in a penumbra.
inline constexpr std::uint32_t kRepairSamples = 1024;

/// View: a map from each of kRepairSamples light samples. As sub-lights shrink, a method whose shadow of a point light
/// is that of a shadow map goes there, however it makes soft ones.
visibility::ErrorRepair points_of_light(const visibility::MethodOptions& options);

/// View: the light in 2 × 2 and 4 × 4 parts, each with maps from its own centre.
visibility::ErrorRepair parted_light(const visibility::MethodDescription& method,
                                     const visibility::MethodOptions& given);

/// Layers: the option `layers` doubled, up to all that there can be.
visibility::ErrorRepair more_layers(const visibility::MethodDescription& method,
                                    const visibility::MethodOptions& given);

/// What the methods of this family differ in when their error is taken apart.
struct MapRepairs {
  std::vector<std::string> doubled = {"size"};      ///< see finer_maps
  bool ends_at_points = false;                      ///< points_of_light, not parted_light
  std::string many_views = {};                      ///< why `view` cannot be separated; empty: it can
  std::string layers = {}, fusion = {}, gaps = {};  ///< why these cannot
  /// What tells a caster from the receiver's own surface with nothing but rounding forgiven.
  visibility::MethodOptions bias = {{"bias", "0.015625"}};
};

/// Repairs of resolution, view and bias, and all of these together; the others are inseparable for the reasons given.
visibility::ErrorRepairs map_repairs(const visibility::MethodDescription& method,
                                     const visibility::MethodOptions& given, const MapRepairs& repairs);

/// The same run with texels a quarter as wide, half as wide, and as they are: what is left of all of these.
std::vector<visibility::RepairRun> from_finest(const visibility::MethodDescription& method,
                                               const visibility::RepairRun& run, std::span<const std::string> doubled);

}  // namespace penumbra::maps
