// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <vector>

namespace penumbra::visibility {

/// View samples of translucent surfaces, with their alpha; pixels without one are background with alpha 0.
struct PaneLayer {
  ViewSamples samples;
  std::vector<float> alpha;
};

/// The translucent surfaces (BLEND) in front of each pixel's carrier, except where their alpha is 0.
class Panes {
 public:
  /// Collects the translucent surfaces in front of each pixel's carrier. `scene` and `seen` must outlive this object.
  Panes(const SceneFloats& scene, const ViewSamples& seen);

  /// Returns the largest number of translucent layers in front of any pixel.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// Returns for each pixel its layer with this number, counted from the eye.
  [[nodiscard]] PaneLayer layer(std::size_t number) const;

 private:
  struct Pane {
    std::int32_t triangle = ViewSamples::kBackground;
    float alpha = 0;
  };
  const SceneFloats& scene_;
  PinholeCamera camera_;
  std::vector<std::vector<Pane>> panes_;  // for each pixel, nearest first; empty: there are none at all
  std::size_t depth_ = 0;
};

}  // namespace penumbra::visibility
