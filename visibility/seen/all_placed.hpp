// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/all_triangles.hpp"
#include "visibility/seen/placed_meshes.hpp"

#include <functional>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// All triangles of placed meshes, made instance by instance, so that memory holds one instance at a time.
class AllPlaced final : public AllTriangles {
 public:
  /// `meshes` must outlive this object.
  explicit AllPlaced(const PlacedMeshes& meshes) : meshes_(meshes) {}

  void for_each_run(const std::function<void(const Run&)>& take) const override;
  void for_each_positions(const std::function<void(std::span<const glm::vec3>)>& take) const override;

 private:
  const PlacedMeshes& meshes_;
};

}  // namespace penumbra::visibility
