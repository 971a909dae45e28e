// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::scenes {

/// How instances are written. copies: each as a separate mesh in world space. shared: the mesh once, with its instances
/// (.json, .glb). automatic: in .glb always shared; in .json shared if reading the file back gives the same scene, or
/// if the scene has more than kFewCopies triangles, else copies.
enum class WriteInstances : std::uint8_t { automatic, copies, shared };

struct WriteOptions {
  bool lenient = false;  ///< leaves out parts that the format cannot hold and that change shadows, with a warning
  WriteInstances instances = WriteInstances::automatic;
};

/// Writes the scene in world space, triangles in the scene's order, in the format of the file's extension:
/// - .json: penumbra-scene/1; reading it back gives the same scene to the last bit (inline triangles share no vertices,
///   and a face is a triangle). A light's texture is written next to it, as "NAME-light0.exr" of "NAME.json".
/// - .glb: positions and other vertex attributes in float32, materials with base colour, pictures and alpha, cameras; a
///   rectangle or polygon light becomes an emissive flat mesh after all others (a disk becomes a polygon with 64
///   sides), unless a mesh of the scene is its body already. A light's texture is replaced by its mean colour.
/// - .obj: an object for each object, geometry only.
///
/// Shared instances become "instances" of a mesh in .json, where objects with the same mesh and surface are joined, and
/// nodes that share a mesh in .glb.
///
/// Returns descriptions of the parts that the format could not hold. The file appears whole or not at all. Throws
/// UsageError for another extension, InputError for losses that would change shadows (unless lenient), ResourceError if
/// the file cannot be written.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& file,
                                     const WriteOptions& options = {}, const Instances& instances = {});

/// Returns the memory that write_scene takes for each triangle: 0 for texts, which are written piece by piece.
std::uint64_t writer_bytes_per_triangle(const std::filesystem::path& file);

/// Returns the files that write_scene writes in addition to `file`: textures.
std::vector<std::filesystem::path> texture_files(const Scene& scene, const std::filesystem::path& file);

}  // namespace penumbra::scenes
