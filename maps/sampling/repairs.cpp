// SPDX-License-Identifier: Apache-2.0
// Options that separate the causes of error of the methods with maps from many points of the light
// (docs/error-budget.md).

#include "maps/sampling/repairs.hpp"

#include "maps/host/error_repairs.hpp"

namespace penumbra::maps {

visibility::ErrorRepairs sampling_repairs(const visibility::MethodDescription& method,
                                          const visibility::MethodOptions& given) {
  return map_repairs(method, given,
                     {.many_views = "it uses maps from points all over the light; more of these points are its repair",
                      .layers = "for each of its points only the nearest surface matters",
                      .fusion = "points of the light are counted: nothing is added or joined",
                      .gaps = "texels are looked up, not projected: there are no gaps between them"});
}

}  // namespace penumbra::maps
