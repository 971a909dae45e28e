#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A part of a light, as a light of its own. It has no texture. A rectangle's part is one, and its samples are the
/// whole light's, closer together; of other lights parts are polygons, and all samples of a part its centroid.
struct LightPart {
  Light light;
  double weight = 1;  ///< of its V in the whole light's: its area, weighed by the texture's luminance. They add up to 1
};

/// A planar light in `count` × `count` parts, row by row along its u (Yang et al. 2009, section 5): a rectangle's are
/// equal, and those that are black are left out; other lights are cut by a grid over their bounding rectangle, a disk
/// or ellipse as the image of a regular polygon of 256 sides and its area (parts of an ellipse are 2e-5 of its area
/// off). Parts of less than 2⁻²⁰ of the grid's cell are left out. Any light in one part is itself. Throws InputError
/// for what has no plane.
std::vector<LightPart> light_parts(const Light& light, std::uint32_t count);

}  // namespace penumbra::visibility
