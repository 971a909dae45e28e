// SPDX-License-Identifier: Apache-2.0
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

// Occluders of a light, as signed edges. Internal to areas/.

namespace penumbra::areas {

/// A scene in which the edges that triangles share are known. Borrows the scene and its tree.
struct WeldedScene {
  const visibility::SceneFloats* scene = nullptr;
  const visibility::TriangleTree* tree = nullptr;
  std::vector<std::uint32_t> corner;  ///< for each position, the index of the first equal position
};
WeldedScene welded(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree);

/// Occluders of the light from one view sample: edges on the light's plane, clipped to a box.
class OccluderEdges {
 public:
  /// Borrows all arguments.
  OccluderEdges(const WeldedScene& scene, const visibility::Light& light, const Receiver& receiver,
                const BackProjection& projection, const LightShaft& shaft);

  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }

  /// Number: double or mpq_class.
  template <typename Number>
  void append_to(std::vector<SweepEdge<Number>>& edges) const;

 private:
  /// Use of an edge from corner `low` to corner `high` by one triangle.
  struct EdgeUse {
    std::uint32_t low, high;
    int count;
  };

  template <typename Visit>
  void for_each_candidate(Visit&& visit) const;
  /// Adds all of a triangle's boundary or nothing: so the sums stay closed, whichever triangles are left out.
  void add_triangle(std::uint32_t triangle);
  /// Clips a triangle, and adds the closing edges along the crossed planes. Along left and right no vertical line
  /// crosses the closing edges, and the space above the top is not measured: the cuts at the light's plane and at the
  /// bottom remain. Returns false if nothing of the triangle is strictly between p and the light.
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
