// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

/// Repair of each cause of error of the methods that filter one map: MethodDescription::repairs.
namespace penumbra::maps {

/// Returns the repairs of shadow-map and pcss.
visibility::ErrorRepairs filter_repairs(const visibility::MethodDescription& method,
                                        const visibility::MethodOptions& given);
visibility::ErrorRepairs vssm_repairs(const visibility::MethodDescription& method,
                                      const visibility::MethodOptions& given);
visibility::ErrorRepairs pcf_repairs(const visibility::MethodDescription& method,
                                     const visibility::MethodOptions& given);
/// Returns the repairs of convolution and occlusion-textures.
visibility::ErrorRepairs slice_repairs(const visibility::MethodDescription& method,
                                       const visibility::MethodOptions& given);

}  // namespace penumbra::maps
