// SPDX-License-Identifier: Apache-2.0
// Options that separate the causes of error of the methods with maps from many points of the light
// (docs/error-budget.md).

#include "maps/sampling/repairs.hpp"

#include "maps/host/error_repairs.hpp"

namespace penumbra::maps {

visibility::ErrorRepairs sampling_repairs(const visibility::MethodDescription& method,
                                          const visibility::MethodOptions& given) {
  return map_repairs(method, given,
                     {.many_views = "it looks from points all over the light; more of them are its repair",
                      .layers = "from each of its points only the nearest surface matters",
                      .fusion = "points of the light are counted: nothing is added or joined",
                      .gaps = "texels are asked, not projected: there is nothing between them"});
}

}  // namespace penumbra::maps
