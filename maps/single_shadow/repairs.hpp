#pragma once

#include "visibility/method.hpp"

/// What repairs each cause of error of the methods of this room: MethodDescription::repairs.
namespace penumbra::maps {

visibility::ErrorRepairs single_shadow_repairs(const visibility::MethodDescription& method,
                                               const visibility::MethodOptions& given);

/// Of those whose search is counted in texels.
visibility::ErrorRepairs searched_shadow_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given);

}  // namespace penumbra::maps
