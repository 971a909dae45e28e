// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::import {

/// Returns at each point of an extrusion's spine (two or more points) the axes of the plane across it: x and z in the
/// plane, y along the spine; ISO/IEC 19775-1, 13.3.5.
std::vector<glm::dmat3> x3d_planes_across(const std::vector<glm::dvec3>& spine);

}  // namespace penumbra::import
