// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/bounds.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::reference {

/// Finds directions in which all points of a box have the same answer, so that no rays need be traced: nothing is in
/// the way of any of them, or one triangle is in the way of all. Rays in float32 have these answers as well.
class CommonAnswers {
 public:
  /// `scene` must outlive this object.
  CommonAnswers(const visibility::SceneFloats& scene, std::span<const glm::vec3> directions);
  void set_directions(std::span<const glm::vec3> directions);

  /// Clears the bits of `clear` (bit j: direction j) in whose directions a triangle may be met from a point of the box.
  /// Triangles of the plane `own`, which is not kNoPlane, are never met. Walks a tree of boxes once for all directions.
  void keep_clear(const visibility::Bounds& box, std::uint32_t own, std::span<std::uint32_t> clear) const;

  /// Sets the bits of directions in which one of the scene's largest triangles is met from each point of the box.
  void add_blocked(const visibility::Bounds& box, std::span<std::uint32_t> blocked) const;

 private:
  struct Search;
  std::uint32_t note_plane(std::uint32_t reference);
  void choose_large();

  const visibility::SceneFloats* scene_;
  visibility::TriangleTree tree_;
  std::vector<std::uint32_t> node_plane_, leaf_plane_;  // the plane of all triangles below; kNoPlane: there are several
  std::vector<std::array<glm::vec3, 3>> large_;         // the triangles that add_blocked tries
  std::vector<glm::dvec3> directions_, inverse_;
};

}  // namespace penumbra::reference
