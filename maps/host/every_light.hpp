#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// The kinds of light and surface that for_every_light() gives a method of maps.
struct Given {
  bool suns = true, spheres = true, holes = true;
};

/// Gives a method of maps the lights that its maps cannot look from, and tells it of surfaces with holes, without its
/// knowing: under a sun it has the scene in SunSpace, where the sun is a disk; a sphere is LampDisks, one after the
/// other, each for the view samples in its pyramid; and triangles with holes (alphaMode MASK) are casters, whose holes
/// CasterMaps leaves out. Lights that the method does itself stay as they are.
/// `given`: the rest, which the method keeps refusing.
std::unique_ptr<visibility::Method> for_every_light(std::unique_ptr<visibility::Method> method, Given given = {});

/// The description of a method that for_every_light() wraps.
visibility::MethodDescription for_every_light(visibility::MethodDescription description, Given given = {});

}  // namespace penumbra::maps
