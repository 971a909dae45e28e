#pragma once

#include "scenes/scene.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::scenes {

/// Where an instance puts its mesh.
struct Placement {
  glm::dmat4 to_world{1};
  /// Which sum is rounded last. On: all of a column times x and the offset, as readers of JSON add them; off: two and
  /// two, as readers of glTF do. So an instance is the mesh's copy in the world to the last bit.
  bool offset_last = false;

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& x) const {
    if (offset_last) return glm::dmat3(to_world) * x + glm::dvec3(to_world[3]);
    return glm::dvec3(to_world * glm::dvec4(x, 1));
  }
  /// Turns it inside out; the corners of its triangles are swapped to make up for that.
  [[nodiscard]] bool mirrors() const { return glm::determinant(glm::dmat3(to_world)) < 0; }
};

/// A unit normal in the world; 0 where there is none.
inline glm::vec3 world_normal(const glm::dmat4& to_world, const glm::dvec3& normal) {
  const glm::dvec3 turned = glm::transpose(glm::inverse(glm::dmat3(to_world))) * normal;
  const double length = glm::length(turned);
  return length > 0 && std::isfinite(length) ? glm::vec3(turned / length) : glm::vec3(0);
}

/// A mesh that is there several times, in its own space. Each position is some triangle's.
struct SharedMesh {
  mesh::TriangleSoup soup;  ///< `object` is 0
  /// As VertexLooks; normals as they were modelled.
  std::vector<glm::dvec3> normals = {};
  std::vector<glm::vec4> colors = {};
  std::vector<glm::dvec2> places = {};
};

struct Instance {
  std::uint32_t mesh = 0, object = 0;  ///< indices into Instances::meshes and Scene::objects
  Placement placement = {};
  std::uint64_t soup_before = 0;  ///< so many triangles of the scene's soup have lower numbers than the instance's
};

/// What of a scene is not in its soup, since it is there several times. Triangles are numbered as if it were.
struct Instances {
  std::vector<SharedMesh> meshes;
  std::vector<Instance> all;  ///< in the order of their triangles' numbers

  [[nodiscard]] bool empty() const { return all.empty(); }
  [[nodiscard]] std::size_t triangles_of(const Instance& instance) const {
    return meshes[instance.mesh].soup.triangles.size();
  }
};

/// All triangles of the scene, those of instances included.
std::uint64_t triangle_count(const Scene& scene, const Instances& instances);

/// A soup to which triangles of instances are added, one after the other.
class SoupBuilder {
 public:
  /// Lists of looks come where the scene or a mesh has them. All must outlive it.
  SoupBuilder(Scene& to, const Scene& from, const Instances& instances);
  /// A triangle of from's soup.
  void add_own(std::uint32_t triangle);
  /// One of an instance. Those of an instance follow one another.
  void add(const Instance& instance, std::uint32_t triangle);

 private:
  template <typename PositionOf>
  void add_corners(mesh::Triangle corners, const PositionOf& position_of);
  void add_own_position(std::uint32_t position);
  void add_position(std::uint32_t position);
  void begin(const Instance& instance);

  Scene& to_;
  const Scene& from_;
  const Instances& instances_;
  bool normals_, colors_, places_;
  std::vector<std::uint32_t> own_;       // of each position of from's soup, its number; kNone: it has not come
  std::vector<std::uint32_t> number_;    // the same of the instance at hand
  std::vector<std::uint32_t> numbered_;  // its positions that have come
  const Instance* at_hand_ = nullptr;
  bool mirrors_ = false;
};

/// The scene with every instance's triangles in its soup. Throws ResourceError, with the numbers, where memory does not
/// suffice.
Scene copied(Scene scene, const Instances& instances);

}  // namespace penumbra::scenes
