// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/silhouettes.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/closed_casters.hpp"
#include "volumes/raster/volume_count.shared.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// A silhouette edge as seen from the light's centre l: its side face runs from a b away from l to infinity.
struct VolumeEdge {
  glm::vec3 a, b;
  std::int32_t multiplicity = 0;  ///< k_e(l), never 0: the number of volumes that end here, with sign
                                  ///< (mesh/silhouettes.hpp)
  std::uint32_t part = 0;         ///< index into LightVolumes::parts
  std::uint32_t caster = 0;       ///< one of the triangles at the edge, index into ShadowCasters
};

/// A triangle that bounds its own volume toward the light.
struct VolumeCap {
  std::array<glm::vec3, 3> corners;  ///< counter-clockwise as seen from l
  std::uint32_t plane = 0;           ///< SceneFloats::plane
  std::uint32_t part = 0;            ///< index into LightVolumes::parts
  std::uint32_t caster = 0;          ///< index into ShadowCasters
};

/// The boundary of all shadow volumes of one point, without the far end. Each triangle has its own volume, everything
/// that it hides from l; between two triangles that are adjacent as seen from l no face remains.
struct LightVolumes {
  glm::vec3 l{0};
  std::vector<VolumeEdge> edges;
  std::vector<VolumeCap> caps;         ///< of every triangle whose plane does not contain l
  std::vector<std::uint8_t> left_out;  ///< for each of the scene's triangles: excluded by Layers::one_a_solid, in
                                       ///< addition to the light's own body; empty: no triangle is
  std::vector<gpu::VolumePart> parts;  ///< each has all edges and caps of some volumes; empty: one part without bounds
};

/// Triangles that have a volume.
enum class Layers {
  every_triangle,
  one_a_solid,  ///< of each closed part only the triangles of one layer (closed_casters.hpp)
};

/// Everything that casts shadows, with its edges. `scene` must outlive this object.
class ShadowCasters {
 public:
  explicit ShadowCasters(const visibility::SceneFloats& scene, Layers layers = Layers::every_triangle);

  /// Returns the volumes as seen from `l`, without the body of that light. Exact.
  [[nodiscard]] LightVolumes seen_from(const glm::vec3& l, const visibility::Light& light) const;
  /// Returns the volumes of some casters only: `kept` has a word for each caster, 0 for those that are excluded.
  [[nodiscard]] LightVolumes seen_from(const glm::vec3& l, const visibility::Light& light,
                                       std::span<const std::uint8_t> kept) const;

  /// Returns the part of seen_from() that needs no facings: for each caster, the sides on which l must be for it to
  /// count (bit 0: front, bit 1: back).
  [[nodiscard]] std::vector<std::uint32_t> counted_sides(const glm::vec3& l, const visibility::Light& light) const;
  /// Returns the volumes, given the edges with k_e(l) ≠ 0 of counting casters, and for each caster the side that l is
  /// on (bits 0 and 1 of `sides`) and which of these bits count (bits 2 and 3).
  [[nodiscard]] LightVolumes assembled(const glm::vec3& l, std::span<const std::uint32_t> sides,
                                       std::span<const mesh::SilhouetteEdge> edges) const;

  [[nodiscard]] std::size_t size() const { return casters_.size(); }
  [[nodiscard]] std::span<const mesh::Triangle> triangles() const { return triangles_; }
  /// Returns for each caster the index, from 0 on, of its component: the casters that edges connect to it.
  [[nodiscard]] std::vector<std::uint32_t> components() const;
  /// Returns for each caster its index among the scene's triangles.
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return casters_; }
  [[nodiscard]] const mesh::EdgeGraph& graph() const { return graph_; }

 private:
  const visibility::SceneFloats* scene_;
  std::vector<glm::dvec3> positions_;
  std::vector<std::uint32_t> casters_;     // indices of the scene's triangles
  std::vector<mesh::Triangle> triangles_;  // their corners
  mesh::EdgeGraph graph_;
  Layers layers_;
  visibility::ClosedCasters parts_;  // for one_a_solid
};

/// Returns for each part how many of its triangles the ray from l in this direction meets; nullopt if double cannot
/// decide.
std::optional<std::vector<std::int32_t>> counts_along(const LightVolumes& volumes, const glm::dvec3& direction);

/// Returns the number of each part's volumes that contain x, regardless of the part's bounds; nullopt if double cannot
/// decide.
std::optional<std::vector<std::int32_t>> counts_at(const LightVolumes& volumes, const glm::dvec3& x);

}  // namespace penumbra::volumes
