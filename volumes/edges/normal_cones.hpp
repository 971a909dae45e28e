// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace penumbra::volumes {

/// Directions within an angle of an axis, up to sign. cosine ≤ 0: all directions.
struct NormalCone {
  glm::dvec3 axis{0};
  double cosine = 1;

  [[nodiscard]] bool is_all() const { return cosine <= 0; }
};

/// The normals of both sides of a leaf's records (EdgeRecord::sides).
struct LeafNormals {
  std::array<std::array<glm::vec3, 2>, visibility::TriangleTree::kWidth> n;
  std::size_t count = 0;
};

/// Returns a cone that contains, up to sign, the two normals of each record such that k_e(p) = 0 where p is in front of
/// both, or behind both.
NormalCone cone_of(const LeafNormals& records);
/// Returns a cone that contains all of `cones`, of which there are at most as many as children of a node.
NormalCone joined(std::span<const NormalCone> cones);

}  // namespace penumbra::volumes
