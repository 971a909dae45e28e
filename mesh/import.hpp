// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec2.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// Coordinate of positions without texture coordinates; far outside of any picture.
inline constexpr glm::dvec2 kNoPlace{-1e9};

struct ImportedMesh {
  TriangleSoup soup;                           ///< one object (number 0), node transforms applied; never empty
  std::vector<std::string> notes;              ///< skipped or changed elements, each kind with its count
  std::vector<std::filesystem::path> sources;  ///< files that were opened, including the mesh's own
  /// Texture coordinates of each position, v upward, or kNoPlace, if requested; empty if the file has none.
  std::vector<glm::dvec2> places = {};
};

/// Limits on the cost of a foreign file; a file that exceeds them is refused.
struct ImportLimits {
  std::chrono::milliseconds time{20000};
  std::uint64_t memory_bytes = 4ull << 30;
  std::uint64_t output_bytes = 4ull << 30;
  const std::function<void()>* step = nullptr;  ///< HelperRun::step
};

/// Reads OBJ, PLY, OFF, STL, AMF and 3MF with readers of this project, glTF/GLB with the reader of scenes, and 3DS and
/// other formats with Assimp.
///
/// The soup keeps all faces: duplicates and degenerate triangles stay. Polygons become triangles (a fan if convex, ear
/// clipping otherwise); lines, points and faces with fewer than three corners are skipped and counted in `notes`, as is
/// everything else that is not geometry.
///
/// The file is parsed in a child process (`penumbra-import`) under `limits`: a file that crashes the parser, hangs it
/// or exhausts its memory gives an InputError with that reason. Also throws InputError for a missing file, no
/// triangles, an index out of range, a vertex that is not finite, and a file shorter than its header promises.
ImportedMesh import_mesh(const std::filesystem::path& file, const ImportLimits& limits = {});

/// Options for glTF files.
struct GltfMeshOptions {
  bool allow_outside = false;  ///< allows buffers outside of the file's folder
  bool lenient = true;         ///< features that change shadows and that a mesh cannot hold (alpha) give a note instead
                               ///< of an InputError
};

/// Reads a mesh file that is already open.
/// `with_places`: reads texture coordinates of OBJ files, too; corners of one vertex with different coordinates then
/// become different positions of the soup.
ImportedMesh import_mesh(const InputFile& input, const ImportLimits& limits = {}, GltfMeshOptions gltf = {},
                         bool with_places = false);

}  // namespace penumbra::mesh
