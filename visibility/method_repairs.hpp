// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/error_repair.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <string>

/// Repairs of the causes of error that methods of all families share: docs/error-budget.md. Throughout, `given` are the
/// options of the run to be explained.
namespace penumbra::visibility {

/// Returns all of a method's options as given, with `more` replacing some of them.
MethodOptions options_with(const MethodDescription& method, const MethodOptions& given, const MethodOptions& more);

/// Returns the repair of a cause that cannot be separated; `words` give the reason.
ErrorRepair inseparable(ErrorCause cause, std::string words);

/// Returns a method's repair of one cause. `repairs` has one entry for each cause, in their order.
ErrorRepair& repair_of(ErrorRepairs& repairs, ErrorCause cause);

/// Number of light samples that approximate the whole light: their V is off by about 0.0025 in a penumbra.
inline constexpr std::uint32_t kRepairSamples = 1024;

/// Returns the repair of the cause `view`: the light in 2 × 2 and 4 × 4 parts, with the scene seen from the centre of
/// each part.
ErrorRepair parted_light(const MethodDescription& method, const MethodOptions& given);

/// Returns the repair of the cause `samples`: the same method with kRepairSamples light samples.
ErrorRepair more_light_samples(const MethodDescription& method, const MethodOptions& given);

/// Returns a run whose V is the visible area itself, for every kind of light.
RepairRun visible_area();

/// Reasons why a method of the geometry family does not have a cause, or why nothing separates it.
struct GeometryReasons {
  std::string resolution = "it has no map: edges have their exact places";
  std::string view = "it computes visibility from every light sample";
  std::string layers = "it uses all surfaces, not only the nearest";
  std::string fusion = "a part of the light that several triangles hide counts once";
  std::string gaps = "neighbouring triangles share their edges: there are no gaps between them";
  std::string bias = "it compares exact signs, which need no bias";
  std::string samples = "it has no light samples";
  std::string falloff = "it does not estimate hidden light from a distance to an edge";
};
/// Returns repairs that separate no cause. `together` computes the visible area.
ErrorRepairs no_repairs(const GeometryReasons& reasons);

/// Returns the repairs of methods whose mask bits are the exact truth of their pairs: light samples are their only
/// cause of error.
ErrorRepairs exact_pair_repairs(const MethodDescription& method, const MethodOptions& given);

/// Returns the repairs of methods that decide exactly whether the light's centre is hidden.
ErrorRepairs exact_centre_repairs(const MethodDescription& method, const MethodOptions& given);

}  // namespace penumbra::visibility
