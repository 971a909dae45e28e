#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// For each light, each view sample, 1: it is a spot lamp among those named, and its cone passes the view sample by, so
/// that its light there is 0 whatever V is. Empty for other lights; empty where there is none of them.
std::vector<std::vector<std::uint8_t>> samples_beside_cones(const visibility::ViewSamples& samples,
                                                            std::span<const visibility::Light> lights,
                                                            std::span<const std::string> named);

}  // namespace penumbra::app
