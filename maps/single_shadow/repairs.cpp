#include "maps/single_shadow/repairs.hpp"

#include "maps/host/error_repairs.hpp"

namespace penumbra::maps {

namespace {

MapRepairs one_edge() {
  return {.ends_at_points = true,
          .layers = "it asks the nearest surfaces; no form of the method asks more",
          .fusion = "one edge alone decides, the nearest: nothing is added or joined",
          .gaps = "texels are searched, not projected: there is nothing between them"};
}

}  // namespace

visibility::ErrorRepairs single_shadow_repairs(const visibility::MethodDescription& method,
                                               const visibility::MethodOptions& given) {
  return map_repairs(method, given, one_edge());
}

visibility::ErrorRepairs searched_shadow_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given) {
  MapRepairs repairs = one_edge();
  // The search is counted in texels: as many again go as far.
  repairs.doubled = {"size", "radius"};
  return map_repairs(method, given, repairs);
}

}  // namespace penumbra::maps
