#pragma once

#include "scenes/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::scenes {

struct WriteOptions {
  bool lenient = false;  ///< leave out what the format cannot hold and would change shadows, with a warning
};

/// Writes the scene in world space, triangles in the scene's order, in the format of the file's extension:
/// - .json: penumbra-scene/1; reading it back gives the same scene to the last bit (inline triangles share no
///   vertices, and a face is a triangle). A light's texture is written beside it, "NAME-light0.exr" of "NAME.json".
/// - .glb: positions and what else vertices have in float32, materials with base colour, pictures and alpha, cameras; a
///   rectangle or polygon light becomes an emissive flat mesh after all others (a disk one with 64 sides), unless a
///   mesh of the scene is its body already. In place of a light's texture stands its mean colour.
/// - .obj: one object each, nothing but geometry.
///
/// Returns what the format could not hold, in words. The file appears whole or not at all. UsageError for another
/// extension, InputError for what would change shadows (unless lenient), ResourceError if it cannot be written.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& file,
                                     const WriteOptions& options = {});

/// The files beside `file` that write_scene writes as well: textures.
std::vector<std::filesystem::path> texture_files(const Scene& scene, const std::filesystem::path& file);

}  // namespace penumbra::scenes
