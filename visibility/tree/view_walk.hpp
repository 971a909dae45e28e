#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// What pixels' rays meet, by a tree of boxes: for cameras that rasterisers do not know, and for pixels where what is
/// nearest has a hole. Agrees with carrier_of; microseconds a pixel.
class ViewWalk {
 public:
  struct Met {
    double t = 0;
    std::uint32_t triangle = 0;
  };

  /// Of these triangles of the scene. Both must outlive it.
  ViewWalk(const SceneFloats& scene, const PinholeCamera& camera, std::vector<std::uint32_t> triangles);

  /// All of them that cover the pixel, nearest first; at equal t in the order of SceneFloats::comes_before.
  void meet(std::uint32_t x, std::uint32_t y, std::vector<Met>& met) const;
  /// carrier_of, if all triangles are among these.
  [[nodiscard]] std::int32_t carrier(std::uint32_t x, std::uint32_t y) const;

 private:
  const SceneFloats& scene_;
  const PinholeCamera& camera_;
  std::vector<std::uint32_t> triangles_;
  TriangleTree tree_;  // its boxes stick out by a pixel: cover() rounds
};

/// All triangles that may be seen: those that have area.
std::vector<std::uint32_t> triangles_with_area(const SceneFloats& scene);

/// View samples of any camera.
ViewSamples walk_view_samples(const SceneFloats& scene, const PinholeCamera& camera);

/// View samples that were found as if every surface were solid: where what carries one has a hole, or is translucent,
/// it is given to what is behind.
ViewSamples look_through(const SceneFloats& scene, const PinholeCamera& camera, ViewSamples solid);

}  // namespace penumbra::visibility
