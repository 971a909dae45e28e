#pragma once

#include "areas/area_sweep.hpp"
#include "areas/back_projection.hpp"
#include "areas/exact_area.hpp"
#include "areas/light_shaft.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

// Inside areas/ only: what hides a light, as signed edges.

namespace penumbra::areas {

/// A scene whose triangles are known to share edges. Borrows it, and its tree.
struct WeldedScene {
  const visibility::SceneFloats* scene = nullptr;
  const visibility::TriangleTree* tree = nullptr;
  std::vector<std::uint32_t> corner;  ///< for each position, the first at its place
};
WeldedScene welded(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree);

/// What hides the light from one view sample: edges on the light's plane, clipped to a box.
class OccluderEdges {
 public:
  /// Borrows everything.
  OccluderEdges(const WeldedScene& scene, const visibility::Light& light, const Receiver& receiver,
                const BackProjection& projection, const LightShaft& shaft);

  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }

  /// Number: double or mpq_class.
  template <typename Number>
  void append_to(std::vector<SweepEdge<Number>>& edges) const;

 private:
  /// One triangle's use of an edge from corner `low` to corner `high`.
  struct EdgeUse {
    std::uint32_t low, high;
    int count;
  };

  template <typename Visit>
  void for_each_candidate(Visit&& visit) const;
  /// All of a triangle's boundary or nothing: then the sums stay closed, whatever is left out.
  void add_triangle(std::uint32_t triangle);
  /// Clipping closes a triangle along the planes it crosses. Along left and right no vertical line crosses what closes
  /// it, above the top none is looked at: the cuts at the light's plane and at the bottom are left. False: nothing of
  /// the triangle is strictly between p and the light.
  bool cut_triangle(const std::array<glm::vec3, 3>& corners, int turn);
  void merge_uses();

  const WeldedScene& scene_;
  const visibility::Light& light_;
  const Receiver& receiver_;
  const BackProjection& projection_;
  const LightShaft& shaft_;
  std::vector<EdgeUse> uses_;
  std::vector<ProjectiveEdge> cuts_;  ///< each counts 1
  std::uint64_t triangles_ = 0;
};

}  // namespace penumbra::areas
