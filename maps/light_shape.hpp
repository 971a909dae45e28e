#pragma once

#include "maps/light_frame.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// `count` points spread evenly over a planar light, in its frame: always the same ones. Any first part of them is
/// spread evenly too. (Unlike Light::points their number is the caller's.)
std::vector<glm::vec2> light_pattern(const visibility::Light& light, const LightFrame& frame, std::uint32_t count);

/// Half the light's width: the radius of the disk of its area.
double half_width(const visibility::Light& light);

}  // namespace penumbra::maps
