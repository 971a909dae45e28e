#pragma once

#include "scenes/scene.hpp"

#include <filesystem>

namespace penumbra::scenes {

struct ReadOptions {
  bool allow_outside = false;  ///< may the scene name files outside its folder?
  bool needs_light = true;     ///< glTF: is a scene without an area light an error?
};

/// Reads .json (penumbra-scene/1), .gltf or .glb by the file's extension. What comes back is complete: at least one
/// object, light (unless `needs_light` is off) and camera, every number finite, every index in range. Otherwise
/// InputError: the file, the place in it (JSON pointer or line), what is there and what would be right.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace penumbra::scenes
