// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/error_repair.hpp"
#include "visibility/method_options.hpp"

namespace penumbra::visibility {
struct MethodDescription;
}  // namespace penumbra::visibility

/// Runs that each avoid one cause of error of the methods in this folder (MethodDescription::repairs;
/// docs/error-budget.md). soft-irregular has options for what these methods share: layers at the light's centre
/// (umbra), silhouettes of the centre, and sums. With umbra=layers its V is that of soft-volume.
namespace penumbra::volumes {

visibility::ErrorRepairs soft_irregular_repairs(const visibility::MethodDescription& method,
                                                const visibility::MethodOptions& given);
visibility::ErrorRepairs soft_volume_repairs(const visibility::MethodDescription& method,
                                             const visibility::MethodOptions& given);
visibility::ErrorRepairs soft_volume_blend_repairs(const visibility::MethodDescription& method,
                                                   const visibility::MethodOptions& given);
visibility::ErrorRepairs wedge_ramp_repairs(const visibility::MethodDescription& method,
                                            const visibility::MethodOptions& given);
visibility::ErrorRepairs plateaus_repairs(const visibility::MethodDescription& method,
                                          const visibility::MethodOptions& given);

}  // namespace penumbra::volumes
