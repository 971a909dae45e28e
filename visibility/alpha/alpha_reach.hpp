// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Finds the view samples at which surfaces that let light through may affect V. At all others the result for opaque
/// surfaces alone is complete for any light samples, and an area is exact.
class AlphaReach {
 public:
  /// `scene` must outlive this object.
  explicit AlphaReach(const SceneFloats& scene);

  /// Returns for each pixel 1 if a triangle that lets light through may be met on the segment from p to some point of
  /// the light; 0 if certainly none is, and where V follows from `classes` (classify_pixels) alone. An empty list means
  /// 0 everywhere. Errs only toward 1: within about 10⁻⁶ of the light's size or distance, and for a disk, in the square
  /// around it.
  [[nodiscard]] std::vector<std::uint8_t> reached(const ViewSamples& samples, const Light& light,
                                                  std::span<const PixelClass> classes) const;

 private:
  const SceneFloats& scene_;
  TriangleTree tree_;  // over scene.alphas.casters
};

/// Makes a tree over the boxes of scene.alphas.casters, in their order.
TriangleTree make_tree_over_alphas(const SceneFloats& scene);

}  // namespace penumbra::visibility
