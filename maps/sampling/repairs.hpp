#pragma once

#include "visibility/method.hpp"

namespace penumbra::maps {

/// What repairs each cause of error of the methods that have maps from many points of the light:
/// MethodDescription::repairs.
visibility::ErrorRepairs sampling_repairs(const visibility::MethodDescription& method,
                                          const visibility::MethodOptions& given);

}  // namespace penumbra::maps
