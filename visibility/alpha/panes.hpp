#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <vector>

namespace penumbra::visibility {

/// View samples of translucent surfaces, with their alpha; pixels without are background with alpha 0.
struct PaneLayer {
  ViewSamples samples;
  std::vector<float> alpha;
};

/// The translucent surfaces (BLEND) that pixels are seen through. Where their alpha is 0 there is none.
class Panes {
 public:
  /// Those before what carries each pixel of `seen`. Both are looked at again by layer().
  Panes(const SceneFloats& scene, const ViewSamples& seen);

  /// The most that one pixel is seen through.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// Of each pixel the one with this number, counted from the eye.
  [[nodiscard]] PaneLayer layer(std::size_t number) const;

 private:
  struct Pane {
    std::int32_t triangle = ViewSamples::kBackground;
    float alpha = 0;
  };
  const SceneFloats& scene_;
  PinholeCamera camera_;
  std::vector<std::vector<Pane>> panes_;  // of each pixel, nearest first; empty: there are none at all
  std::size_t depth_ = 0;
};

}  // namespace penumbra::visibility
