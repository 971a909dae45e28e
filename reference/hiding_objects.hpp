#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::reference {

/// Whose triangles hide some of a light from a view sample.
struct HiddenBy {
  bool own = false;    ///< those of the object that carries it
  bool other = false;  ///< those of another object
};

/// For each of the given pixels, which carry view samples: every triangle that a ray to a light sample meets is looked
/// at. Rays go to sixteen light samples, spread over the light, and to the others in turn until one is hidden, so a
/// part of the light that none of them hits goes unseen. `scene`: where only casters of this light's shadows cast.
std::vector<HiddenBy> hiding_objects(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                     const visibility::Light& light, std::span<const std::uint32_t> pixels);

}  // namespace penumbra::reference
