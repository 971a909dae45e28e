#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace penumbra::reference {

/// Whose triangles hide some of a light from a view sample, and how far away.
struct HiddenBy {
  bool own = false;    ///< those of the object that carries it
  bool other = false;  ///< those of another object
  /// The shortest way along a ray to one of them, in scene floats; infinity: none was met.
  double nearest = std::numeric_limits<double>::infinity();
  /// How wide a penumbra they make there, in extents of the light (of a sun, at distance 1): of the nearest on each
  /// hidden ray, a share s of the way to the light off, the mean of s / (1 − s), as between parallel planes; of a sun
  /// the mean way. 0: none was met.
  double widening = 0;
};

/// For each of the given pixels, which carry view samples: every triangle that a ray to a light sample meets is looked
/// at. Rays go to sixteen light samples, spread over the light, and, if none of these is hidden, to the others in turn
/// until one is, so a part of the light that none of them hits goes unseen. `scene`: where only casters of this light's
/// shadows cast.
std::vector<HiddenBy> hiding_objects(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                     const visibility::Light& light, std::span<const std::uint32_t> pixels);

}  // namespace penumbra::reference
