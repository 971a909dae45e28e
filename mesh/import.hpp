#pragma once

#include "mesh/input_file.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec2.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// Far outside of any picture: of a position without texture coordinates.
inline constexpr glm::dvec2 kNoPlace{-1e9};

struct ImportedMesh {
  TriangleSoup soup;                           ///< one object (number 0), node transforms applied; never empty
  std::vector<std::string> notes;              ///< what was skipped or changed on the way, each with its count
  std::vector<std::filesystem::path> sources;  ///< files that were opened on the way, the mesh's own among them
  /// Texture coordinates of each position, v upward, or kNoPlace, where they were asked for; empty: the file has none.
  std::vector<glm::dvec2> places = {};
};

/// What a foreign file may cost before it is refused.
struct ImportLimits {
  std::chrono::milliseconds time{20000};
  std::uint64_t memory_bytes = 4ull << 30;
  std::uint64_t output_bytes = 4ull << 30;
};

/// Reads OBJ, PLY, OFF, STL, AMF and 3MF by readers of our own, glTF/GLB by the scenes', and 3DS and whatever else it
/// reads by Assimp.
///
/// The soup drops no face with an area or without: duplicates and degenerate triangles stay. Polygons become triangles
/// (a fan if convex, ear clipping otherwise); lines, points and faces with fewer than three corners are skipped and
/// counted in `notes`, as is everything else that is not geometry.
///
/// The file is parsed in a child process (`penumbra-import`) under `limits`: a file that crashes, hangs or eats memory
/// costs an InputError that says so. InputError also for: no such file, no triangles, an index out of range, a vertex
/// that is not finite, a file shorter than its header promises.
ImportedMesh import_mesh(const std::filesystem::path& file, const ImportLimits& limits = {});

/// Of glTF files.
struct GltfMeshOptions {
  bool allow_outside = false;  ///< buffers may be anywhere; else in the file's folder and below
  bool lenient = true;         ///< what changes shadows and a mesh cannot hold (alpha) is a note; else InputError
};

/// Reads a mesh file that has been opened already.
/// `with_places`: OBJ files' texture coordinates, too; then corners of one vertex that have different ones are
/// different positions of the soup.
ImportedMesh import_mesh(const InputFile& input, const ImportLimits& limits = {}, GltfMeshOptions gltf = {},
                         bool with_places = false);

}  // namespace penumbra::mesh
