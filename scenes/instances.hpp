// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::scenes {

/// Transform of an instance's mesh to the world.
struct Placement {
  glm::dmat4 to_world{1};
  /// Order of the sums, so that an instance equals the mesh's copy in the world to the last bit. True: the offset is
  /// added last, as readers of JSON add it; false: the products are added in pairs, as readers of glTF do.
  bool offset_last = false;

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& x) const {
    if (offset_last) return glm::dmat3(to_world) * x + glm::dvec3(to_world[3]);
    return glm::dvec3(to_world * glm::dvec4(x, 1));
  }
  /// Returns whether the transform turns the mesh inside out; then the corners of its triangles are swapped to
  /// compensate.
  [[nodiscard]] bool mirrors() const { return glm::determinant(glm::dmat3(to_world)) < 0; }
};

/// Returns a unit normal in the world; 0 if there is none.
inline glm::vec3 world_normal(const glm::dmat4& to_world, const glm::dvec3& normal) {
  const glm::dvec3 turned = glm::transpose(glm::inverse(glm::dmat3(to_world))) * normal;
  const double length = glm::length(turned);
  return length > 0 && std::isfinite(length) ? glm::vec3(turned / length) : glm::vec3(0);
}

/// A mesh that the scene has several times, in its own space. Each position belongs to a triangle.
struct SharedMesh {
  mesh::TriangleSoup soup;  ///< `object` is 0
  /// Looks as in VertexLooks; normals in the mesh's own space.
  std::vector<glm::dvec3> normals = {};
  std::vector<glm::vec4> colors = {};
  std::vector<glm::dvec2> places = {};
};

struct Instance {
  std::uint32_t mesh = 0, object = 0;  ///< indices into Instances::meshes and Scene::objects
  Placement placement = {};
  std::uint64_t soup_before = 0;  ///< number of the soup's triangles that are numbered before the instance's triangles
};

/// Triangles of a scene that are not in its soup, because their meshes are shared. Their numbers are those that they
/// would have in the soup.
struct Instances {
  /// Never null, and never changed, so that trees over these meshes (visibility/seen/) stay valid.
  std::vector<std::shared_ptr<const SharedMesh>> meshes;
  std::vector<Instance> all;  ///< in the order of their triangles' numbers

  [[nodiscard]] bool empty() const { return all.empty(); }
  [[nodiscard]] std::size_t triangles_of(const Instance& instance) const {
    return meshes[instance.mesh]->soup.triangles.size();
  }
};

/// Number of triangles up to which instances are copied by default: copies cost less than doing without them.
inline constexpr std::uint64_t kFewCopies = 500'000;

/// Returns the number of the scene's triangles, including those of instances.
std::uint64_t triangle_count(const Scene& scene, const Instances& instances);

/// Returns the index into Scene::objects of a triangle, by its number in the whole scene.
std::uint32_t object_of(const Scene& scene, const Instances& instances, std::uint64_t triangle);

/// A soup to which triangles of instances are added, one after the other.
class SoupBuilder {
 public:
  /// Adds lists of looks if the scene or a mesh has them. All arguments must outlive this object.
  SoupBuilder(Scene& to, const Scene& from, const Instances& instances);
  /// Adds a triangle of the soup of `from`.
  void add_own(std::uint32_t triangle);
  /// Adds a triangle of an instance. Triangles of one instance must follow one another.
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
  std::vector<std::uint32_t> own_;       // new number of each position of the soup of `from`; kNone: not added yet
  std::vector<std::uint32_t> number_;    // new number of each position of the current instance
  std::vector<std::uint32_t> numbered_;  // positions of the current instance that were added
  const Instance* at_hand_ = nullptr;
  bool mirrors_ = false;
};

/// Returns the scene with every instance's triangles in its soup. `more_bytes`: memory for each triangle that the
/// caller needs afterwards, in addition to the scene. Throws ResourceError, with the figures, before anything is copied
/// if memory does not suffice.
Scene copied(Scene scene, const Instances& instances, std::uint64_t more_bytes);

}  // namespace penumbra::scenes
