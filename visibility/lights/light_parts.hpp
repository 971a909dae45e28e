#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A part of a light, as a light of its own. It has no texture; its samples are the whole light's, closer together.
struct LightPart {
  Light light;
  double weight = 1;  ///< of its V in the whole light's: its area, weighed by the texture's luminance. They add up to 1
};

/// A rectangle light in `count` × `count` equal parts, row by row along its u (Yang et al. 2009, section 5); parts that
/// are black are left out. Any light in one part is itself. Throws InputError for other shapes in more.
std::vector<LightPart> light_parts(const Light& light, std::uint32_t count);

}  // namespace penumbra::visibility
