// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_view.shared.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::selftest {

/// Possible results of a rasteriser for a triangle at a texel. The rasteriser snaps corners to a grid, computes corners
/// and depths in floats, and must cover exactly the snapped triangle (docs/rasterisers.md).
struct Surface {
  double depth = 0;          ///< at the texel's centre, of the exact triangle: w / far
  double low = 0, high = 1;  ///< range of depths for a triangle whose corners are off by their largest error
  bool sure = false;         ///< covered wherever each corner lies within its step; false: possibly covered
  std::size_t triangle = 0;  ///< index in the twin
};

/// One face of a map drawn in double arithmetic: caster.vert, caster.frag and a rasteriser whose corners may be off by
/// `step` of a texel in x and y.
class RasterTwin {
 public:
  /// `corners`: three for each triangle, as on the device.
  RasterTwin(const maps::gpu::CasterPush& face, std::uint32_t size, double step, std::span<const glm::vec3> corners);

  /// Finds the surfaces that a texel certainly or possibly has, in any order.
  void find(std::uint32_t x, std::uint32_t y, std::vector<Surface>& surfaces) const;

 private:
  struct Triangle {
    std::array<glm::dvec3, 3> edge, edge_error;  ///< E_i(c) = edge_i · c, c = (x, y, 1) on the screen
    std::array<double, 3> snap;                  ///< change of E_i by a step
    glm::dvec3 plane, plane_error;               ///< 1 / w = plane · c / volume
    double volume = 0, volume_error = 0;         ///< of the three corners; positive
    bool flat = false;                           ///< the volume's sign is uncertain: seen edge-on
    bool boxed = false;                          ///< completely in front: `lower` and `upper` contain the triangle
    glm::dvec2 lower{0}, upper{0};
  };
  std::uint32_t size_;
  double step_, near_, far_;  // step_: on the screen, −1 … 1
  std::vector<Triangle> triangles_;
};

/// Comparison of a texel's value with its possible values: the nearest surface, the nearest behind another, or the
/// farthest.
struct Judged {
  bool right = true;
  bool settled = false;  ///< the texel's surface does not depend on any step; then the next two are valid
  double difference = 0, allowed = 0;
};
/// `found`: the map's value, 1 for an empty texel.
Judged judge_nearest(std::span<const Surface> surfaces, double found);
/// Judges a layer behind the surface of the previous one, with peel.frag's factor between the two.
Judged judge_behind(std::span<const Surface> surfaces, double found, double previous);
/// `found`: the map's value, 0 for an empty texel.
Judged judge_farthest(std::span<const Surface> surfaces, double found);

/// Returns the largest possible difference of two maps of the same surfaces at a texel; infinite where a step decides
/// the surface. `farthest`: the maps hold the farthest, else the nearest surface.
double largest_disagreement(std::span<const Surface> surfaces, bool farthest);

}  // namespace penumbra::selftest
