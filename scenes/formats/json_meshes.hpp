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

/// What the JSON reader does with one entry of "meshes" or a value in it. All take values that the schema has passed.
/// Internal to scenes/.
namespace penumbra::scenes {

glm::dvec3 read_vector(const nlohmann::json& value);

struct SceneFile {
  mesh::InputFile input;
  std::filesystem::path path;  ///< where it lies, with links resolved as they were when it was opened
};

/// The named file, from the scene file's folder, opened. What leads out of the folder, by its name or through links, is
/// refused unless the options allow it. InputError also for what does not exist, is no regular file or is empty.
SceneFile open_scene_file(const std::string& name, const Place& place, const ReadOptions& options);

/// Reads, generates or lists the mesh, and brings it into world space, once for each of its instances. What was changed
/// on the way goes to `scene.warnings`, the files that were read to `scene.sources`; ReadOptions::lightmap gets the
/// places of its positions after those that are there.
mesh::TriangleSoup read_mesh(const nlohmann::json& mesh, const Place& place, const ReadOptions& options, Scene& scene);

/// Coordinates of pictures whose v runs upward, as OBJ has them, with v from the top; kNoPlace stays.
std::vector<glm::dvec2> from_top(std::vector<glm::dvec2> places);
/// Those of the vertices that drop_unused_vertices keeps.
std::vector<glm::dvec2> places_of_kept(std::vector<glm::dvec2> places, const std::vector<std::uint32_t>& kept);

/// What the whole document's "meshes" say of their own size must fit into memory together; asked before the first of
/// them is made. Files count nothing here: how much is in them is known when they are read. Throws ResourceError with
/// the figures, and InputError for a shape that cannot be.
void require_room_for_meshes(const nlohmann::json& meshes, const Place& place);

/// Generates the mesh of a "shape".
mesh::TriangleSoup read_shape(const nlohmann::json& shape);
/// How large it will be.
mesh::ShapeSize size_of_shape(const nlohmann::json& shape);

/// Applies "transform" (an object or a row-major matrix) to every position.
void apply_transform(const nlohmann::json& transform, const Place& place, mesh::TriangleSoup& soup);

/// Applies "fit" to every position.
void apply_fit(const nlohmann::json& fit, const Place& place, mesh::TriangleSoup& soup);

}  // namespace penumbra::scenes
