// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

/// Repair of each cause of error of the methods that project patches: MethodDescription::repairs.
namespace penumbra::maps {

visibility::ErrorRepairs backproject_repairs(const visibility::MethodDescription& method,
                                             const visibility::MethodOptions& given);
visibility::ErrorRepairs peel_repairs(const visibility::MethodDescription& method,
                                      const visibility::MethodOptions& given);
visibility::ErrorRepairs bitmask_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given);

visibility::ErrorRepairs layer_ray_repairs(const visibility::MethodDescription& method,
                                           const visibility::MethodOptions& given);

}  // namespace penumbra::maps
