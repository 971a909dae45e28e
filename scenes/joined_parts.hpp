#pragma once

#include "scenes/scene.hpp"

#include <cstdint>
#include <span>

namespace penumbra::scenes {

/// Some neighbouring objects of a scene, and some neighbouring lights: all that these objects are bodies of, and
/// others.
struct ScenePart {
  const Scene* scene = nullptr;
  std::uint32_t first_object = 0, objects = 0;
  std::uint32_t first_light = 0, lights = 0;
  bool casts_shadows = true;  ///< of these lights: else no object of the whole casts a shadow
};

/// The scene that parts make together: what a reader makes of one file that has all of them in this order. It has no
/// cameras. Objects and lights whose names are taken get numbers. `with_meshes`: else it is without triangles, pictures
/// and vertices' looks. Triangles of an object stand together in its scene, and so do its vertices, which are its own.
Scene joined(std::span<const ScenePart> parts, bool with_meshes);

}  // namespace penumbra::scenes
