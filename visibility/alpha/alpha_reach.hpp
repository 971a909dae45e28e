#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Where what lets light through may take part in V: at all other view samples the answer of what stops all light is
/// the whole answer, whatever light samples there are, and an area is exact.
class AlphaReach {
 public:
  /// `scene` must outlive it.
  explicit AlphaReach(const SceneFloats& scene);

  /// For each pixel, 1: a triangle that lets light through may be met on the way from p to some point of the light. 0:
  /// certainly none is, and wherever V follows from `classes` (classify_pixels) alone. Empty: 0 everywhere. It errs to
  /// the side of 1 alone, by about 10⁻⁶ of the light's size or distance, and where a disk's corners would be.
  [[nodiscard]] std::vector<std::uint8_t> reached(const ViewSamples& samples, const Light& light,
                                                  std::span<const PixelClass> classes) const;

 private:
  const SceneFloats& scene_;
  TriangleTree tree_;  // over scene.alphas.casters
};

/// Over the boxes of scene.alphas.casters, in their order.
TriangleTree make_tree_over_alphas(const SceneFloats& scene);

}  // namespace penumbra::visibility
