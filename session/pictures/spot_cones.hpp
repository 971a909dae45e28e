// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Returns for each light, for each view sample, 1 if the light is one of the named spot lamps and the view sample is
/// outside its cone, so that its light is 0 there whatever V is. Empty for other lights; empty if there is no such
/// lamp.
std::vector<std::vector<std::uint8_t>> samples_beside_cones(const visibility::ViewSamples& samples,
                                                            std::span<const visibility::Light> lights,
                                                            std::span<const std::string> named);

}  // namespace penumbra::session
