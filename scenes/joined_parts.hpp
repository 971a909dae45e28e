// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <cstdint>
#include <span>

namespace penumbra::scenes {

/// Contiguous objects of a scene, and contiguous lights: all lights whose bodies are among these objects, and possibly
/// others.
struct ScenePart {
  const Scene* scene = nullptr;
  std::uint32_t first_object = 0, objects = 0;
  std::uint32_t first_light = 0, lights = 0;
  bool casts_shadows = true;  ///< false: no object of the joined scene casts a shadow of these lights
};

/// Returns the scene joined from parts, without cameras: equal to the scene of one file with all parts in this order.
/// Objects and lights with a taken name get numbers. If `with_meshes` is false, the scene has no triangles, pictures
/// and vertices' looks. In each part's scene, triangles of an object must be contiguous, as well as its vertices, which
/// must not be shared.
Scene joined(std::span<const ScenePart> parts, bool with_meshes);

}  // namespace penumbra::scenes
