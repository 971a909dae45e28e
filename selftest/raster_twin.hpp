#pragma once

#include "maps/host/map_view.shared.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::selftest {

/// What a rasteriser may make of a triangle at a texel. It snaps corners to a grid, computes them and their depths in
/// floats, and must cover exactly what the snapped triangle covers (docs/rasterisers.md).
struct Surface {
  double depth = 0;          ///< at the texel's centre, of the triangle as it is: w / far
  double low = 0, high = 1;  ///< what it can be of a triangle whose corners are off by what they may be
  bool sure = false;         ///< covered wherever in its step each corner lies; else: perhaps
  std::size_t triangle = 0;  ///< which of the twin's
};

/// One face of a map drawn in double arithmetic: caster.vert, caster.frag and a rasteriser whose corners may be off by
/// `step` of a texel in x and y.
class RasterTwin {
 public:
  /// `corners`: three a triangle, as the device has them.
  RasterTwin(const maps::gpu::CasterPush& face, std::uint32_t size, double step, std::span<const glm::vec3> corners);

  /// The surfaces that a texel has, or perhaps has, in any order.
  void find(std::uint32_t x, std::uint32_t y, std::vector<Surface>& surfaces) const;

 private:
  struct Triangle {
    std::array<glm::dvec3, 3> edge, edge_error;  ///< E_i(c) = edge_i · c, c = (x, y, 1) on the screen
    std::array<double, 3> snap;                  ///< how much a step changes E_i
    glm::dvec3 plane, plane_error;               ///< 1 / w = plane · c / volume
    double volume = 0, volume_error = 0;         ///< of the three corners; positive
    bool flat = false;                           ///< the volume's sign is not sure: seen edge-on
    bool boxed = false;                          ///< wholly in front: `lower` and `upper` hold it
    glm::dvec2 lower{0}, upper{0};
  };
  std::uint32_t size_;
  double step_, near_, far_;  // step_: on the screen, −1 … 1
  std::vector<Triangle> triangles_;
};

/// What a texel holds against what it may hold: the nearest surface, the nearest behind another, or the farthest.
struct Judged {
  bool right = true;
  bool settled = false;  ///< which surface it holds does not depend on any step; then:
  double difference = 0, allowed = 0;
};
/// `found`: as the map holds it, 1 where it holds nothing.
Judged judge_nearest(std::span<const Surface> surfaces, double found);
/// Behind what the layer before holds; peel.frag has the factor.
Judged judge_behind(std::span<const Surface> surfaces, double found, double previous);
/// 0 where it holds nothing.
Judged judge_farthest(std::span<const Surface> surfaces, double found);

/// How far two maps of the same surfaces may differ at a texel; infinite where a step decides which surface it is.
/// `farthest`: they hold the farthest, else the nearest surface.
double largest_disagreement(std::span<const Surface> surfaces, bool farthest);

}  // namespace penumbra::selftest
