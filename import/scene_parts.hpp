// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

struct aiMesh;
struct aiScene;

namespace penumbra::import {

/// Contents of a scene file read by Assimp other than its triangles, in world space and the scene's unit.
struct SceneParts {
  /// Mesh placed by a node.
  struct Part {
    std::string name;
    std::size_t first_triangle = 0;  ///< first triangle; the part ends at the next part's
    std::string material;
    glm::dvec3 color{0.8}, emission{0};
    double opacity = 1;
    bool has_picture = false, has_cut = false;  ///< a colour image; an opacity image
  };
  struct Lamp {
    enum class Kind { point, spot, sun, other };
    std::string name;
    Kind kind = Kind::other;
    glm::dvec3 position{0}, direction{0, -1, 0}, color{0};
    double inner = 0, outer = 0;  ///< of a spot lamp, half angles in radians
  };
  struct Lens {
    std::string name;
    glm::dvec3 eye{0}, forward{0, 0, -1}, up{0, 1, 0};
    double horizontal_fov = 0, aspect = 0;  ///< in radians; width over height
  };
  std::vector<Part> parts;
  std::vector<Lamp> lamps;
  std::vector<Lens> lenses;
  std::vector<glm::vec3> normals;  ///< of each position, 0 if the file has none
  unsigned uv = 0;                 ///< requested set of coordinates for `places`
  std::vector<glm::dvec2> places;  ///< of each position, v from the top; mesh::kNoPlace if the file has none
  std::string generator;           ///< program named by the file as its writer
  bool moves = false;              ///< the file has animations
  bool white_is_grey = false;      ///< written by Blender's FBX exporter: white lamps are 0.8 times as bright as
                                   ///< intended
  bool has_orthographic = false;   ///< the file has an orthographic camera, which Assimp converts to a perspective one
};

SceneParts::Part part_of(const aiScene& scene, const aiMesh& mesh, const std::string& name);

/// Returns the names of the materials of the scene's meshes that let light through.
std::vector<std::string> transparent_materials(const aiScene& scene);

/// Adds lamps and cameras. `places`: for each node's name, the node's transform.
void add_lamps_and_lenses(const aiScene& scene, const std::map<std::string, glm::dmat4, std::less<>>& places,
                          SceneParts& parts);

/// Returns whether a file has an orthographic camera.
bool has_orthographic_camera(std::string_view content);

/// Returns whether a binary FBX file has default properties of lamps. Blender writes a camera's properties there, which
/// makes white lamps grey.
bool has_template_of_lamps(std::string_view content);

}  // namespace penumbra::import
