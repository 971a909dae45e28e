#pragma once

#include "scenes/instances.hpp"
#include "visibility/seen/box_tree.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// The sum of a vector's components without their signs.
inline double sum_of_sides(const glm::dvec3& x) {
  const glm::dvec3 wide = glm::abs(x);
  return wide.x + wide.y + wide.z;
}

/// A scene's meshes where they are, without copies of them: a tree over each mesh's triangles in its own space, and one
/// over where instances are. All that comes out is relative to the scene's origin.
class PlacedMeshes {
 public:
  /// An instance, or all that the scene has without instances.
  struct Part {
    const mesh::TriangleSoup* soup = nullptr;
    const BoxTree* tree = nullptr;
    const scenes::Instance* instance = nullptr;  ///< nothing: the scene's soup, which is in the world
    std::uint64_t first_bit = 0;                 ///< its first triangle among all parts', one after the other
    glm::dmat3 linear{1}, wide{1};               ///< from a box's middle and half sides to those in the world
    glm::dvec3 offset{0};
    /// What positions are off by in double and in float32, over what boxes are.
    double room = 0;

    [[nodiscard]] MiddleBox box(const MiddleBox& own) const {
      return {linear * own.middle + offset, wide * own.half + room};
    }
  };

  /// Both must outlive it.
  PlacedMeshes(const scenes::Scene& scene, const scenes::Instances& instances);
  PlacedMeshes(const PlacedMeshes&) = delete;
  PlacedMeshes& operator=(const PlacedMeshes&) = delete;

  [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
  [[nodiscard]] const scenes::Instances& instances() const { return instances_; }
  [[nodiscard]] std::span<const Part> parts() const { return parts_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }  ///< over parts
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  /// Of all positions, in the world and relative to the origin: those of the scene in which each instance is a copy.
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  [[nodiscard]] const glm::dvec3& lower() const { return lower_; }
  [[nodiscard]] const glm::dvec3& upper() const { return upper_; }
  /// How large triangles are that meshes are made of, about.
  [[nodiscard]] double grain() const { return grain_; }

  /// A triangle's scene floats, in the order of SceneFloats::triangles.
  [[nodiscard]] std::array<glm::vec3, 3> corners(const Part& part, std::uint32_t triangle) const;
  [[nodiscard]] std::uint32_t object(const Part& part, std::uint32_t triangle) const {
    return part.instance != nullptr ? part.instance->object : part.soup->object[triangle];
  }
  /// What trees take.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  void measure();
  void place();

  const scenes::Scene& scene_;
  const scenes::Instances& instances_;
  BoxTree own_;                 // of the scene's soup
  std::vector<BoxTree> trees_;  // of each mesh
  std::vector<Part> parts_;
  BoxTree tree_;
  std::uint64_t triangles_ = 0;
  glm::dvec3 origin_{0}, lower_{0}, upper_{0};
  double grain_ = 0;
};

}  // namespace penumbra::visibility
