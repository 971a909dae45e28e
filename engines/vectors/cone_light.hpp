// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/clusters.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/near_casters.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Spheres and suns: each view sample sees a different round cone. The positions of light samples in the square around
/// the cone are the same for all, so all share tiles; the casters that may matter to a few view samples are found
/// through a rectangle in a plane behind all of their light points. docs/edge-scatter.md, "Spheres and suns".
namespace penumbra::vectors {

struct ConeOptions {
  std::string method;         ///< method name in errors
  bool light_samples = true;  ///< else the method integrates over the light itself: cells are then independent of light
                              ///< samples
  bool cuts_casters = false;  ///< the method cuts casters at the disks of a sphere that view samples see
};

/// `tree` must be that of the scene; `light` must outlive this object.
class ConeLight {
 public:
  /// Throws InputError if float32 cannot represent light and scene together.
  ConeLight(const visibility::Light& light, const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
            const ConeOptions& options);

  /// Returns the grid with tiles and masks, not yet oriented toward any view samples.
  [[nodiscard]] LightGrid make_grid() const;
  /// Classifies as vectors::classify does; for the result in_front also sets `cone`, the light as p sees it.
  SampleClass classify(const ViewInput& view, std::uint32_t pixel, GridSample& at, LightCone& cone) const;
  /// Orients the grid toward view samples that have cones, and sets their places over it. Returns false if the
  /// directions to the light differ too much for a common rectangle. For a single view sample always returns true.
  [[nodiscard]] bool turn(LightGrid& grid, std::span<GridSample> samples) const;
  /// Returns the casters that may meet a disk of the sphere that any view sample sees, for methods that cut casters.
  [[nodiscard]] const NearCasters& near() const { return near_side_by_side_; }

 private:
  [[nodiscard]] bool touches(const LightGrid::Cones& cones, const LightCone& cone, const glm::dvec3& p) const;

  const visibility::Light& light_;
  bool light_samples_, cuts_casters_;
  double scale_;
  double tangent_ = 0;    // for a sun: tangent of half the angle of the cone inside the square
  double deviation_ = 0;  // error of a stored light point (for a sun: at distance 1), scaled
  double beyond_ = 0;     // for a sun: all casters are nearer to it than this height, scaled
  float reach_ = 0;
  std::vector<NearCaster> near_;
  NearCasters near_side_by_side_;
};

/// Returns a cluster without bounds: all casters may matter to a method.
Cluster everything(std::span<const GridSample> samples);
/// Adds to `at` the data that `complete` needs for a sphere or sun.
void see_cone(const LightGrid& grid, ClusterSample& at);

}  // namespace penumbra::vectors
