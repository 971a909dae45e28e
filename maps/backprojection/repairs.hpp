#pragma once

#include "visibility/method.hpp"

/// What repairs each cause of error of the methods that project texels back: MethodDescription::repairs.
namespace penumbra::maps {

visibility::ErrorRepairs backproject_repairs(const visibility::MethodDescription& method,
                                             const visibility::MethodOptions& given);
visibility::ErrorRepairs peel_repairs(const visibility::MethodDescription& method,
                                      const visibility::MethodOptions& given);
visibility::ErrorRepairs bitmask_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given);
/// Of contour and packet.
visibility::ErrorRepairs contour_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given);
visibility::ErrorRepairs soft_shadow_map_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given);

}  // namespace penumbra::maps
