// SPDX-License-Identifier: Apache-2.0
// Options that separate the causes of error of the methods that filter one map (docs/error-budget.md).

#include "maps/filters/repairs.hpp"

#include "maps/host/error_repairs.hpp"

namespace penumbra::maps {
namespace {

using visibility::ErrorRepairs;
using visibility::MethodDescription;
using visibility::MethodOptions;

MapRepairs one_surface() {
  return {.layers = "it reads only the nearest surfaces; no form of the method reads more",
          .fusion = "it averages the results of texels: nothing is added or joined",
          .gaps = "texels are averaged, not projected: there are no gaps between them"};
}

}  // namespace

ErrorRepairs filter_repairs(const MethodDescription& method, const MethodOptions& given) {
  MapRepairs repairs = one_surface();
  repairs.ends_at_points = true;
  return map_repairs(method, given, repairs);
}

ErrorRepairs vssm_repairs(const MethodDescription& method, const MethodOptions& given) {
  return map_repairs(method, given, one_surface());
}

ErrorRepairs pcf_repairs(const MethodDescription& method, const MethodOptions& given) {
  MapRepairs repairs = one_surface();
  // The window is given in texels: doubling the number keeps the window's width.
  repairs.doubled = {"size", "window"};
  return map_repairs(method, given, repairs);
}

ErrorRepairs slice_repairs(const MethodDescription& method, const MethodOptions& given) {
  MapRepairs repairs = one_surface();
  repairs.layers = "its slices hold all surfaces";
  repairs.fusion = "slices are assumed to be independent; no form of the method joins them";
  return map_repairs(method, given, repairs);
}

}  // namespace penumbra::maps
