// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "volumes/edges/device/facing.shared.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::volumes {

/// Triangles and points in the format of silhouette_facing.comp, with the error bounds of volumes/README.md (Bounds).
class FacingUpload {
 public:
  /// `positions`: those of the mesh; they determine the power of two that brings their largest coordinate into [1, 2).
  explicit FacingUpload(std::span<const glm::vec3> positions);

  /// Returns the triangles, padded with triangles without area to a whole number of words of 32.
  [[nodiscard]] std::vector<gpu::FacingTriangle> triangles(std::span<const mesh::Triangle> triangles) const;
  [[nodiscard]] std::vector<gpu::FacingPoint> points(std::span<const glm::vec3> points) const;

 private:
  std::span<const glm::vec3> positions_;
  int exponent_ = 0;     // exponent of the scale
  bool coarse_ = false;  // nothing underflows (bound underflow)
};

}  // namespace penumbra::volumes
