// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace penumbra::volumes {

/// Relation of at most 32 light samples to the carrier's plane, as bits.
struct Horizon {
  std::uint32_t above = 0;  ///< strictly above the plane; exact
  std::uint32_t open = 0;   ///< samples in `above` for which sums over edges may be wrong
};

/// Triangles on the carrier's plane do not block anything, but their edges count. If rounding moved p behind the plane,
/// the segment from p to a point l crosses the plane within |h(p)| / h(l) of its length from p, h being the height over
/// the plane. If no edge of a triangle on the plane is that near to p, the segments to the light's centre and to a
/// light sample cross the same of these triangles. The exact count at the centre and the sum over edges then omit the
/// same triangles for both.
class CarrierHorizon {
 public:
  /// `alone`: no other triangle is on its plane. `facing`: ViewSamples::facing.
  CarrierHorizon(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree, std::uint32_t carrier,
                 std::int8_t facing, bool alone);

  /// Computes the horizon of at most 32 light samples at p. `open` is meaningful only if the light's centre is above
  /// the plane.
  [[nodiscard]] Horizon at(const glm::vec3& p, const glm::vec3& center, std::span<const glm::vec3> points) const;

 private:
  [[nodiscard]] double height(const glm::vec3& x) const;
  [[nodiscard]] double error(const glm::vec3& x) const;
  [[nodiscard]] bool is_behind(const glm::vec3& p) const;
  [[nodiscard]] double reach(const glm::vec3& p, const glm::vec3& l) const;
  [[nodiscard]] double distance_to_edges(const glm::vec3& p, double farthest) const;

  const visibility::SceneFloats& scene_;
  const visibility::TriangleTree& tree_;
  std::uint32_t carrier_;
  std::int8_t facing_;
  bool alone_;
  std::array<glm::vec3, 3> corners_;
  glm::dvec3 normal_{0};  // toward the viewer; heights are in units of its length
  double size_ = 0;       // errors of heights are proportional to it
};

}  // namespace penumbra::volumes
