#pragma once

#include "maps/host/light_basis.hpp"
#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// A part of a light, as a light of its own, without texture or samples.
struct SubLight {
  visibility::Light light;
  LightBasis basis;
  double weight = 1;  ///< of its V in the whole light's: its area, weighed by the texture's luminance. They add up to 1
};

/// A rectangle light in `count` × `count` equal parts, row by row along its u (Yang et al. 2009, section 5); parts that
/// are black are left out. Any light in one part is itself. Throws InputError for other shapes in more.
std::vector<SubLight> sub_lights(const visibility::Light& light, std::uint32_t count);

}  // namespace penumbra::maps
