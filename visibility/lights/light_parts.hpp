// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/light_texture.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A part of a light. A rectangle's part is a rectangle with its part of the texture, unless this is constant, and its
/// samples are the whole light's, scaled down and without weights; parts of other lights are polygons, and all samples
/// of a part are at its centroid.
struct LightPart {
  Light light;
  double weight = 1;  ///< weight of its V in the whole light's: its area, times the texture's luminance. The weights
                      ///< add up to 1
};

/// Returns the texture of part (column, row), from s = t = −1, of a rectangle cut in n × n: exact, with each texel
/// itself cut in n × n.
LightTexture texture_part(const LightTexture& texture, std::uint32_t n, const glm::uvec2& part);

/// Divides a planar light into `count` × `count` parts, row by row along its u (Yang et al. 2009, section 5): a
/// rectangle's are equal, and black ones are left out; other lights are cut by a grid over their bounding rectangle, a
/// disk or ellipse as the image of a regular polygon of 256 sides with its area (parts of an ellipse are off by 2e-5 of
/// its area). Parts of less than 2⁻²⁰ of the grid's cell are left out. With `count` 1 every light is its own only part.
/// Throws InputError for a light without a plane.
std::vector<LightPart> light_parts(const Light& light, std::uint32_t count);

}  // namespace penumbra::visibility
