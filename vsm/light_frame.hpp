#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::vsm {

/// A planar light as device passes see it: its samples lie at center + s·u + t·v with s, t in [−1, 1], up to
/// `deviation`. u × v points to the emitting side. In float32, scaled by `scale`.
struct LightFrame {
  glm::vec3 center{0}, u{0}, v{0};
  /// The samples form rows: sample (row, column) is at s = row_starts[row].x + column · 2 / columns, t = row_starts[row].y.
  /// Empty if they do not (a disk's, a polygon's, sobol, jittered).
  std::vector<glm::vec2> row_starts;
  std::vector<glm::vec2> coordinates;  ///< (s, t) of each light sample, contract order
  float deviation = 0;                 ///< the largest distance of a stored sample from its place in this frame
};

/// `scale` is a power of two. Not for spheres.
LightFrame make_light_frame(const visibility::Light& light, float scale);

}  // namespace penumbra::vsm
