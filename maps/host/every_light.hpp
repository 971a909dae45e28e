// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Kinds of light and surface added to a method of maps by for_every_light().
struct Given {
  bool suns = true, spheres = true, holes = true;
};

/// Extends a method of maps to lights that its maps cannot view from, and to surfaces with holes, without changes in
/// the method: for a sun the scene is given in SunSpace, where the sun is a disk; a sphere is given as LampDisks, one
/// after the other, each for the view samples in its pyramid; and triangles with holes (alphaMode MASK) are casters,
/// whose holes CasterMaps leaves out. Lights supported by the method itself are unchanged. `given`: the kinds to add;
/// the method keeps rejecting the others.
std::unique_ptr<visibility::Method> for_every_light(std::unique_ptr<visibility::Method> method, Given given = {});

/// Returns the description of a method wrapped by for_every_light().
visibility::MethodDescription for_every_light(visibility::MethodDescription description, Given given = {});

}  // namespace penumbra::maps
