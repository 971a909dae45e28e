// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"
#include "mesh/shapes/shapes.hpp"
#include "mesh/triangle_soup.hpp"
#include "scenes/formats/json_document.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

/// Reading of an entry of "meshes" and of values in it. All functions take values that the schema has accepted.
/// Internal to scenes/.
namespace penumbra::scenes {

glm::dvec3 read_vector(const nlohmann::json& value);

struct SceneFile {
  mesh::InputFile input;
  std::filesystem::path path;  ///< path of the file, with links resolved when it was opened
};

/// Opens the named file, relative to the scene file's folder. A file outside of the folder, by its name or through
/// links, is refused unless the options allow it. Throws InputError also for a file that does not exist, is not a
/// regular file or is empty.
SceneFile open_scene_file(const std::string& name, const Place& place, const ReadOptions& options);

/// Opens the picture of a dome in the same manner; the file goes to `scene.sources`.
Texture read_sky(const std::string& name, const Place& place, const ReadOptions& options, Scene& scene);

/// Makes the mesh of the scene's last object: reads its file, generates it, takes its listed triangles, or copies it
/// from ReadOptions::given. Transforms it to world space, once for each of its instances; with ReadOptions::instances,
/// returns the mesh before any of their transforms. Changes are reported in `scene.warnings`, read files in
/// `scene.sources`; the mesh's lightmap coordinates are appended to ReadOptions::lightmap.
mesh::TriangleSoup read_mesh(const nlohmann::json& mesh, const Place& place, const ReadOptions& options, Scene& scene);

/// Converts picture coordinates whose v runs upward, as OBJ has them, to v from the top; kNoPlace stays.
std::vector<glm::dvec2> from_top(std::vector<glm::dvec2> places);
/// Returns the coordinates of the vertices that drop_unused_vertices keeps.
std::vector<glm::dvec2> places_of_kept(std::vector<glm::dvec2> places, const std::vector<std::uint32_t>& kept);

/// Adds the mesh, as read_mesh returns it with ReadOptions::instances, as a shared mesh. Its instances belong to
/// `object`, and come after the triangles and instances already in the scene.
void add_instances(const nlohmann::json& instances, const Place& place, mesh::TriangleSoup mesh, std::uint32_t object,
                   const Scene& scene, Instances& to);

/// Checks that all entries of "meshes" whose size is known in advance fit into memory together, before the first is
/// made. Instances that are not copies (`shared`) count once; copies count with `bytes_per_copy` of ReadOptions. Files
/// are not counted: their size is known only after reading. Throws ResourceError with the figures, and InputError for
/// an impossible shape.
void require_room_for_meshes(const nlohmann::json& meshes, const Place& place, bool shared,
                             std::uint64_t bytes_per_copy);

/// Generates the mesh of a "shape".
mesh::TriangleSoup read_shape(const nlohmann::json& shape);
/// Returns the size of the mesh that read_shape will generate.
mesh::ShapeSize size_of_shape(const nlohmann::json& shape);

/// Applies "transform" (an object or a row-major matrix) to every position.
void apply_transform(const nlohmann::json& transform, const Place& place, mesh::TriangleSoup& soup);

/// Applies "fit" to every position.
void apply_fit(const nlohmann::json& fit, const Place& place, mesh::TriangleSoup& soup);

}  // namespace penumbra::scenes
