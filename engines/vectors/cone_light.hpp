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

/// Spheres and suns: each view sample sees a round cone of its own. Where its light samples are in the square around
/// the cone is the same for all, so they share tiles; what may matter to a few view samples is found through a
/// rectangle of a plane behind all of their light points. docs/edge-scatter.md, "Spheres and suns".
namespace penumbra::vectors {

struct ConeOptions {
  std::string method;         ///< names errors
  bool light_samples = true;  ///< else the light itself: cells have nothing to do with light samples
  bool cuts_casters = false;  ///< the method cuts casters at the disks that view samples see of a sphere
};

/// `tree` is that of the scene; `light` must outlive it.
class ConeLight {
 public:
  /// Throws InputError where float32 cannot span light and scene together.
  ConeLight(const visibility::Light& light, const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
            const ConeOptions& options);

  /// Tiles and masks; not yet turned to any view samples.
  [[nodiscard]] LightGrid make_grid() const;
  /// As vectors::classify; an answer in_front comes with how p sees the light.
  SampleClass classify(const ViewInput& view, std::uint32_t pixel, GridSample& at, LightCone& cone) const;
  /// Turns the grid to view samples that have cones, and places them over it. False: they see the light from such
  /// different sides that no rectangle will do. One alone always sees it through one.
  [[nodiscard]] bool turn(LightGrid& grid, std::span<GridSample> samples) const;
  /// Of a sphere, for methods that cut casters: those that may meet the disk that anyone sees.
  [[nodiscard]] const NearCasters& near() const { return near_side_by_side_; }

 private:
  [[nodiscard]] bool touches(const LightGrid::Cones& cones, const LightCone& cone, const glm::dvec3& p) const;

  const visibility::Light& light_;
  bool light_samples_, cuts_casters_;
  double scale_;
  double tangent_ = 0;    // of a sun: of half the angle of the cone that the square is around
  double deviation_ = 0;  // of a stored light point (of a sun: at distance 1), scaled
  double beyond_ = 0;     // of a sun: all casters are nearer to it than this height, scaled
  float reach_ = 0;
  std::vector<NearCaster> near_;
  NearCasters near_side_by_side_;
};

/// A cluster of which everything may matter to a method.
Cluster everything(std::span<const GridSample> samples);
/// What `complete` adds for a sphere or sun.
void see_cone(const LightGrid& grid, ClusterSample& at);

}  // namespace penumbra::vectors
