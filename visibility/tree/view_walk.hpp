// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// Finds the hits of pixels' rays by a tree of boxes: for cameras that rasterisers do not support, and for pixels whose
/// nearest surface has a hole. Agrees with carrier_of; takes microseconds for a pixel.
class ViewWalk {
 public:
  struct Met {
    double t = 0;
    std::uint32_t triangle = 0;
  };

  /// Uses only these triangles of the scene. `scene` and `camera` must outlive this object.
  ViewWalk(const SceneFloats& scene, const PinholeCamera& camera, std::vector<std::uint32_t> triangles);

  /// Lists all of the triangles that cover the pixel, nearest first; at equal t in the order of
  /// SceneFloats::comes_before.
  void meet(std::uint32_t x, std::uint32_t y, std::vector<Met>& met) const;
  /// Returns carrier_of, if all triangles are included.
  [[nodiscard]] std::int32_t carrier(std::uint32_t x, std::uint32_t y) const;

 private:
  const SceneFloats& scene_;
  const PinholeCamera& camera_;
  std::vector<std::uint32_t> triangles_;
  TriangleTree tree_;  // its boxes are enlarged by a pixel: cover() rounds
};

/// Returns all triangles that may be visible: those with an area.
std::vector<std::uint32_t> triangles_with_area(const SceneFloats& scene);

/// Returns the view samples of any camera.
ViewSamples walk_view_samples(const SceneFloats& scene, const PinholeCamera& camera);

/// Corrects view samples that were found as if every surface were opaque: where the carrier has a hole, or is
/// translucent, the pixel is given to the surface behind.
ViewSamples look_through(const SceneFloats& scene, const PinholeCamera& camera, ViewSamples solid);

}  // namespace penumbra::visibility
