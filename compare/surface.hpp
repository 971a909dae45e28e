// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::compare {

/// Appearance of the surface at each pixel.
struct SurfaceLooks {
  /// Linear base colour: the object's × its picture's × its vertices'; background 0. Empty: only objects have colours.
  std::vector<glm::dvec3> colors;
  std::vector<glm::vec3>
      normals;  ///< unit, on the viewer's side of the geometric normal; empty: not requested, or there are none
};

/// Returns the surface at each view sample. `floats` must be made from `scene`. Uses barycentric coordinates of p
/// in the carrier's plane, in double; pictures at level 0, with the nearest texel or bilinear between texel centres, in
/// linear light; vertices' colours and normals interpolated linearly. Triangles stay flat if a vertex has no normal, or
/// if the normals equal the triangle's own up to rounding.
SurfaceLooks look_at(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                     const visibility::ViewSamples& samples, bool shading_normals);

}  // namespace penumbra::compare
