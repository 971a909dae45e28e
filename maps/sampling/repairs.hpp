// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

namespace penumbra::maps {

/// Returns the repair of each cause of error of the methods with maps from many points of the light:
/// MethodDescription::repairs.
visibility::ErrorRepairs sampling_repairs(const visibility::MethodDescription& method,
                                          const visibility::MethodOptions& given);

}  // namespace penumbra::maps
