// SPDX-License-Identifier: Apache-2.0
#pragma once
// A square parallel to a square light and a floor: every pair of view sample and light sample is known in closed form.

#include "tests/analytic/maps/fixture.hpp"

namespace penumbra::tests {

/// The floor is at height 0 (object 0), the occluder [−1, 1]² at height 2 (object 1), the light of half-size 1 at 5.
/// `reach` extends the occluder toward −x: with a large value it is a half-plane whose edge is at x = 1.
inline scenes::Scene parallel_square(double reach = 1, double half_width = 1) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  add_quad(scene, {(1 - reach) / 2, 2, 0}, {(1 + reach) / 2, 0, 0}, {0, 0, half_width});
  scene.lights.push_back(ceiling_light(5, 1));
  scene.cameras.push_back(camera({0.3, 1.5, 6}, {0, 0, 0}, 60));
  return scene;
}

class ParallelSquare {
 public:
  explicit ParallelSquare(const Stage& stage) : stage_(&stage) {
    lower_ = upper_ = stage.floats.positions[6];  // the floor has the first six positions, the occluder the next six
    for (std::size_t i = 7; i < 12; ++i) {
      lower_ = glm::min(lower_, glm::dvec3(stage.floats.positions[i]));
      upper_ = glm::max(upper_, glm::dvec3(stage.floats.positions[i]));
    }
  }
  [[nodiscard]] bool on_floor(std::size_t pixel) const {
    const std::int32_t triangle = stage_->samples.triangle[pixel];
    return triangle >= 0 && stage_->floats.object[static_cast<std::size_t>(triangle)] == 0;
  }
  /// Returns whether light sample j sees the floor at this pixel.
  [[nodiscard]] bool visible(std::size_t pixel, std::size_t j) const {
    const glm::dvec3 p = stage_->samples.p[pixel], l = stage_->light.points[j];
    const glm::dvec3 at = p + (l - p) * ((lower_.y - p.y) / (l.y - p.y));
    return at.x < lower_.x || at.x > upper_.x || at.z < lower_.z || at.z > upper_.z;
  }
  [[nodiscard]] double visibility(std::size_t pixel) const {
    std::size_t count = 0;
    for (std::size_t j = 0; j < stage_->light.points.size(); ++j) count += visible(pixel, j) ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(stage_->light.points.size());
  }
  /// Returns the visible share of the light itself: 1 − the share covered by the occluder's rectangle as seen from p.
  [[nodiscard]] double area(std::size_t pixel) const {
    const glm::dvec3 p = stage_->samples.p[pixel], c = stage_->light.center;
    const double to_light = (c.y - p.y) / (lower_.y - p.y);
    double covered = 1;
    for (const int axis : {0, 2}) {
      const double from = p[axis] + (lower_[axis] - p[axis]) * to_light,
                   to = p[axis] + (upper_[axis] - p[axis]) * to_light;
      covered *= std::max(0.0, std::min(to, c[axis] + 1) - std::max(from, c[axis] - 1)) / 2;
    }
    return 1 - covered;
  }

 private:
  const Stage* stage_;
  glm::dvec3 lower_, upper_;
};

}  // namespace penumbra::tests
