// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "visibility/seen/box_tree.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Returns the sum of the absolute values of a vector's components.
inline double sum_of_sides(const glm::dvec3& x) {
  const glm::dvec3 wide = glm::abs(x);
  return wide.x + wide.y + wide.z;
}

/// A scene's meshes in the world, without copies of instances: a tree over each mesh's triangles in its own space, and
/// one over all instances. All results are relative to the scene's origin.
class PlacedMeshes {
 public:
  /// An instance, or all triangles of the scene that are in no instance.
  struct Part {
    const mesh::TriangleSoup* soup = nullptr;
    const BoxTree* tree = nullptr;
    const scenes::Instance* instance = nullptr;  ///< null: the scene's soup, which is in the world
    std::uint64_t first_bit = 0;                 ///< number of its first triangle, counted over all parts in order
    glm::dmat3 linear{1}, wide{1};               ///< transform a box's middle and half sides to the world
    glm::dvec3 offset{0};
    /// Largest rounding error of positions, in double and in float32, by which boxes are enlarged.
    double room = 0;
    MiddleBox in_world = {};  ///< box around all of the part's triangles
    /// Inverse of `linear`, if there is one with relative errors below 2⁻³²; then rays may be traced in the part's own
    /// space.
    glm::dmat3 to_own{0};
    bool has_own = false;
    glm::dvec3 own_reach{0};  ///< sums of the absolute values in each row of `to_own`

    [[nodiscard]] MiddleBox box(const MiddleBox& own) const {
      return {linear * own.middle + offset, wide * own.half + room};
    }
  };

  PlacedMeshes() = default;
  PlacedMeshes(const scenes::Scene& scene, const scenes::Instances& instances) { place(scene, instances); }
  PlacedMeshes(const PlacedMeshes&) = delete;
  PlacedMeshes& operator=(const PlacedMeshes&) = delete;

  /// Places the meshes of another scene, or of the same one after a change. Trees over meshes that the last scene had
  /// are kept. Both arguments must outlive all calls until the next place() or leave().
  void place(const scenes::Scene& scene, const scenes::Instances& instances);
  /// Releases the scene, and keeps the trees over its shared meshes.
  void leave();
  /// Returns the number of trees over shared meshes that the last place() built.
  [[nodiscard]] std::size_t trees_built() const { return trees_built_; }

  [[nodiscard]] const scenes::Scene& scene() const { return *scene_; }
  [[nodiscard]] const scenes::Instances& instances() const { return *instances_; }
  [[nodiscard]] std::span<const Part> parts() const { return parts_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }  ///< over parts
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  /// Origin and bounds of all positions, in the world and relative to the origin, as in the scene with instances as
  /// copies.
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  [[nodiscard]] const glm::dvec3& lower() const { return lower_; }
  [[nodiscard]] const glm::dvec3& upper() const { return upper_; }
  /// Returns the approximate size of four neighbouring triangles of the meshes.
  [[nodiscard]] double grain() const { return grain_; }

  /// Returns the scene floats of a part's position.
  [[nodiscard]] glm::vec3 position(const Part& part, std::size_t number) const;
  /// Returns a triangle's scene floats, in the order of SceneFloats::triangles.
  [[nodiscard]] std::array<glm::vec3, 3> corners(const Part& part, std::uint32_t triangle) const;
  [[nodiscard]] std::uint32_t object(const Part& part, std::uint32_t triangle) const {
    return part.instance != nullptr ? part.instance->object : part.soup->object[triangle];
  }
  /// Returns the memory of the trees.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  /// Tree over a mesh's triangles.
  struct MeshTree {
    std::shared_ptr<const scenes::SharedMesh> mesh;  // null: the scene's soup
    BoxTree tree;
    double grain = 0;  // size of four neighbouring triangles, in the mesh's own space
  };
  [[nodiscard]] static MeshTree tree_of(const mesh::TriangleSoup& soup);
  void find_trees();
  void measure();
  void put_in_world();

  const scenes::Scene* scene_ = nullptr;
  const scenes::Instances* instances_ = nullptr;
  MeshTree own_;                 // over the scene's soup
  std::vector<MeshTree> trees_;  // for each mesh
  std::size_t trees_built_ = 0;
  std::vector<Part> parts_;
  BoxTree tree_;
  std::uint64_t triangles_ = 0;
  glm::dvec3 origin_{0}, lower_{0}, upper_{0};
  double grain_ = 0;
};

}  // namespace penumbra::visibility
