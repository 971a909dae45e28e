// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace penumbra::reference {

/// Objects whose triangles hide some of a light from a view sample, and their distance.
struct HiddenBy {
  bool own = false;    ///< a triangle of the object that carries the view sample
  bool other = false;  ///< a triangle of another object
  /// The shortest distance along a ray to a hiding triangle, in scene floats; infinity: none was met.
  double nearest = std::numeric_limits<double>::infinity();
  /// The width of these triangles' penumbra at the view sample, in extents of the light (for a sun, at distance 1): the
  /// mean of s / (1 − s) over hidden rays, as between parallel planes, where s is the fraction of the ray at which the
  /// nearest triangle hides the light; for a sun the mean distance. 0: none was met.
  double widening = 0;
};

/// Finds the hiding objects for each of the given pixels, which must carry view samples: inspects every triangle that a
/// ray to a light sample meets. Rays go to sixteen light samples, spread over the light, and, if none of these is
/// hidden, to the others in turn until one is; an occluder that hides no light sample is not found. `scene`: only
/// casters of this light's shadows, if the light restricts them.
std::vector<HiddenBy> hiding_objects(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                     const visibility::Light& light, std::span<const std::uint32_t> pixels);

}  // namespace penumbra::reference
