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

namespace penumbra::mesh {

/// What a scene file that Assimp reads holds beside its triangles, in world space and the scene's unit.
struct SceneParts {
  /// A mesh where a node puts it.
  struct Part {
    std::string name;
    std::size_t first_triangle = 0;  ///< it has these up to the next part's
    std::string material;
    glm::dvec3 color{0.8}, emission{0};
    double opacity = 1;
    bool has_picture = false, has_cut = false;  ///< an image of its colour, one of its opacity
  };
  struct Lamp {
    enum class Kind { point, spot, sun, other };
    std::string name;
    Kind kind = Kind::other;
    glm::dvec3 position{0}, direction{0, -1, 0}, color{0};
    double inner = 0, outer = 0;  ///< of a spot, half angles in radians
  };
  struct Lens {
    std::string name;
    glm::dvec3 eye{0}, forward{0, 0, -1}, up{0, 1, 0};
    double horizontal_fov = 0, aspect = 0;  ///< radians; width over height
  };
  std::vector<Part> parts;
  std::vector<Lamp> lamps;
  std::vector<Lens> lenses;
  std::vector<glm::vec3> normals;  ///< of each position, 0 where the file has none
  unsigned uv = 0;                 ///< asked for: which coordinates `places` are
  std::vector<glm::dvec2> places;  ///< of each position, v from the top; mesh::kNoPlace where the file has none
  std::string generator;           ///< the program that wrote the file, as it says itself
  bool moves = false;              ///< has it animations?
  bool white_is_grey = false;      ///< Blender's FBX exporter: lamps that it means to be white are 0.8 times as bright
  bool has_orthographic = false;   ///< a camera without perspective, of which Assimp makes one with perspective
};

SceneParts::Part part_of(const aiScene& scene, const aiMesh& mesh, const std::string& name);

/// `places`: of each node's name, where the node is.
void add_lamps_and_lenses(const aiScene& scene, const std::map<std::string, glm::dmat4, std::less<>>& places,
                          SceneParts& parts);

/// Has a file a camera without perspective?
bool has_orthographic_camera(std::string_view content);

/// Does the file, a binary FBX, say what a lamp is that says nothing of itself? Blender writes a camera's properties
/// there, by which white lamps are grey.
bool has_template_of_lamps(std::string_view content);

}  // namespace penumbra::mesh
