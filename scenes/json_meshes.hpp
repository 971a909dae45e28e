#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/json_document.hpp"
#include "scenes/reader.hpp"
#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

/// What the JSON reader does with one entry of "meshes" or a value in it. All take values that the schema has passed.
/// Internal to scenes/.
namespace penumbra::scenes {

glm::dvec3 read_vector(const nlohmann::json& value);

/// The named file, from the scene file's folder. Links are resolved before it is decided what lies outside. InputError
/// for what does not exist, or lies outside and may not.
std::filesystem::path resolve_file(const std::string& name, const Place& place, const ReadOptions& options);

/// Reads, generates or lists the mesh, and brings it into world space. What was changed on the way goes to
/// `scene.warnings`, the files that were read to `scene.sources`.
mesh::TriangleSoup read_mesh(const nlohmann::json& mesh, const Place& place, const ReadOptions& options, Scene& scene);

/// Generates the mesh of a "shape".
mesh::TriangleSoup read_shape(const nlohmann::json& shape);

/// Applies "transform" (an object or a row-major matrix) to every position.
void apply_transform(const nlohmann::json& transform, const Place& place, mesh::TriangleSoup& soup);

/// Applies "fit" to every position.
void apply_fit(const nlohmann::json& fit, const Place& place, mesh::TriangleSoup& soup);

}  // namespace penumbra::scenes
