#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace penumbra::volumes {

/// What a carrier's plane says of a view sample on it: bits of light samples, at most 32.
struct Horizon {
  std::uint32_t above = 0;  ///< strictly above it. Exact
  std::uint32_t open = 0;   ///< of those, the ones that sums over edges may be wrong for
};

/// Triangles on the carrier's plane are not met, but their edges count. Where p was rounded to behind the plane, the
/// ways from p to a point l go through the plane no farther from p than |h(p)| / h(l) of them, h the height over it. If
/// no edge of a triangle on it is that near, the ways to the light's centre and to a light sample go through the same
/// of these triangles, and what the centre's exact count leaves out is what the sum over edges leaves out for both.
class CarrierHorizon {
 public:
  /// `alone`: no other triangle is on its plane. `facing`: ViewSamples::facing.
  CarrierHorizon(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree, std::uint32_t carrier,
                 std::int8_t facing, bool alone);

  /// The light's centre must be above the plane for `open` to say anything.
  [[nodiscard]] Horizon at(const glm::vec3& p, const glm::vec3& center, const visibility::Light& light) const;

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
  double size_ = 0;       // what errors of heights are in proportion to
};

}  // namespace penumbra::volumes
