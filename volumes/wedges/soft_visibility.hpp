// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/predicates.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/wedges/radial_coverage.hpp"
#include "volumes/wedges/texture_weights.hpp"
#include "volumes/wedges/wedge_casters.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// View sample as stored by ViewSamples.
struct LitPoint {
  glm::vec3 p{0};
  std::uint32_t carrier = 0;
  std::int8_t facing = 0;
};

/// Viewpoint whose silhouettes are summed.
enum class Viewer {
  center,    ///< k_e(c), one set for all view samples: the method's choice
  receiver,  ///< k_e(p): the actual layers
};

/// An edge that takes light from a view sample, or gives it back.
struct CoveredEdge {
  std::uint32_t edge = 0;         ///< index in the casters' graph
  std::int32_t multiplicity = 0;  ///< k_e of the counted triangles, never 0 (closed_casters.hpp)
  std::int8_t side = 0;           ///< +1: the clipped edge turns counter-clockwise around the reference point. Exact
  ClippedEdge clipped;            ///< in frame coordinates
  double area = 0;          ///< contribution to `blocked`: ± k_e times the area beyond the edge, as a fraction of
                            ///< |L|, or times its weight
  std::int32_t change = 0;  ///< layers of the region beyond the edge, as seen from the reference point, minus those of
                            ///< the region in front of the edge
};

struct LayerSum {
  bool in_front = false;       ///< p is in front of the light; if false, no other member is set, and V = 0
  glm::vec3 reference{0};      ///< point of the light from which areas are measured: its centre, unless edges end there
  glm::dvec2 reference_at{0};  ///< the reference point in frame coordinates
  bool moved = false;          ///< the reference point is not the centre
  std::int32_t constant = 0;   ///< layers at the reference point. Exact
  std::vector<CoveredEdge> edges;  ///< edges that appear on the light, by index
  double sum = 0;                  ///< sum of the edges' areas
  double blocked = 0;              ///< constant + sum: the mean number of layers over the light
  double above = 1;                ///< fraction of the light above the carrier's plane
  double visibility = 0;           ///< 1 − blocked, but not below 0 nor beyond `above`
};

/// Soft shadow volumes (Assarsson and Akenine-Möller 2003) at one view sample: C++ twin of the method `soft-volume`,
/// for rectangle, convex polygon and disk lights; and for spheres, where each p has the disk visible from p.
/// docs/coverage.md derives the equations.
///
/// For a textured light, |L| and areas are replaced by the integral of its luminance and the fractions of this
/// integral. `above` stays a fraction of |L|, as in the method.
///
/// Let D(l) be the number of layers between p and the light point l; `blocked` is its mean over the light. With the
/// receiver's own silhouettes, D counts the triangles met by p→l (of closed parts half of them: closed_casters.hpp),
/// and `blocked` is the hidden fraction where no layers overlap. With the centre's silhouettes, a triangle with p and c
/// on the same side counts −1: this is the method's approximation.
///
/// Triangles coplanar with the carrier do not count, nor does a triangle that touches p. D at the reference point and
/// the side of every edge are exact, with ties as defined in docs/definitions.md, so that no result is off by a whole
/// light.
class SoftVisibility {
 public:
  /// Borrows all three arguments; `casters` are casters_of(scene, light). Throws ResourceError if a texture is too
  /// large (TextureWeights).
  SoftVisibility(const visibility::SceneFloats& scene, const visibility::Light& light, const Casters& casters,
                 Arc arc = Arc::tangent);

  /// `at_most_one` clamps the layers at the reference point to one.
  [[nodiscard]] LayerSum at(const LitPoint& sample, Viewer viewer, bool at_most_one = false) const;

  /// Returns the fraction of these points of the light, given in frame coordinates, at which D is 0: the union of what
  /// the sum adds, tested at points, as in Forest et al. 2008. With `weights`, returns the sum of these points'
  /// weights. `sum`: result of at() or at_center(), with all layers.
  [[nodiscard]] static double visible_share(const LayerSum& sum, std::span<const glm::dvec2> points,
                                            std::span<const double> weights);
  /// Returns the light's samples in frame coordinates. Planar lights only (asserted).
  [[nodiscard]] std::vector<glm::dvec2> light_samples() const;

  /// Edge of the counted triangles and its k_e, by index.
  using Silhouette = std::pair<std::uint32_t, std::int32_t>;
  /// at_center() is at() with Viewer::center, for callers that have edges, and perhaps the layers at the light's
  /// centre, already. Edges that do not appear on the light may be left out.
  struct CenterCount {
    std::optional<std::int32_t> layers = {};  ///< layers at the light's centre, if already counted
    bool at_most_one = false;                 ///< clamp the number of layers to one
  };
  [[nodiscard]] LayerSum at_center(const LitPoint& sample, std::span<const Silhouette> edges,
                                   const CenterCount& count) const;
  /// Returns the edges with k_e(c) ≠ 0, the same for all view samples.
  [[nodiscard]] const std::vector<Silhouette>& silhouettes_of_center() const { return silhouettes_; }
  [[nodiscard]] bool may_appear(const LightProjection& from, std::uint32_t edge) const;
  /// Returns whether a triangle of the scene counts as a layer at the light's centre (first function), and its
  /// contribution there for a view sample (second function).
  [[nodiscard]] bool counts_at_center(std::uint32_t triangle) const;
  [[nodiscard]] std::int32_t layer_at_center(const LitPoint& sample, std::uint32_t triangle) const {
    return layer_of(triangle, sample, center_, Viewer::center);
  }

  /// Returns the triangles that count for the receiver and may appear on the receiver's light: the layers, one by one.
  /// layer_areas.hpp computes `blocked` from these triangles without edges.
  [[nodiscard]] std::vector<std::array<glm::vec3, 3>> layers(const LitPoint& sample) const;

  /// Returns whether any caster meets the light itself. No edge bounds the caster's shadow there, and no sum is exact.
  [[nodiscard]] bool something_touches_light() const;

  [[nodiscard]] const LightOutline& outline() const { return outline_; }
  /// Returns nullptr if the light has no texture: all of the light has the same weight.
  [[nodiscard]] const TextureWeights* texture() const { return texture_ ? &*texture_ : nullptr; }
  [[nodiscard]] std::vector<Silhouette> silhouettes(const LitPoint& sample, Viewer viewer) const;

 private:
  struct Candidate {
    std::uint32_t edge;
    std::int32_t multiplicity;
    ClippedEdge clipped;
  };

  [[nodiscard]] bool is_left_out(std::uint32_t caster, const LitPoint& sample) const;
  [[nodiscard]] bool counts_for_receiver(std::uint32_t caster, mesh::Side seen) const;
  [[nodiscard]] std::vector<Silhouette> center_silhouettes(const LitPoint& sample,
                                                           std::span<const Silhouette> of_all) const;
  [[nodiscard]] std::vector<Silhouette> receiver_silhouettes(const LitPoint& sample) const;
  [[nodiscard]] glm::vec3 center_from(const glm::vec3& p) const;
  [[nodiscard]] std::vector<glm::vec3> corners_from(const glm::vec3& p) const;
  [[nodiscard]] glm::vec3 choose_reference(const glm::vec3& p, const LightProjection& projection,
                                           std::span<const Candidate> edges) const;
  [[nodiscard]] std::int32_t layers_at(const LitPoint& sample, const glm::vec3& l, Viewer viewer) const;
  [[nodiscard]] std::int32_t layer_of(std::uint32_t triangle, const LitPoint& sample, const glm::vec3& l,
                                      Viewer viewer) const;
  [[nodiscard]] LayerSum sum_of(const LitPoint& sample, Viewer viewer, std::span<const Silhouette> edges,
                                const CenterCount& count) const;
  [[nodiscard]] double area_beyond(const Candidate& edge, int side, const RadialCoverage& coverage,
                                   const glm::dvec2& reference) const;
  [[nodiscard]] double share_above_carrier(const LitPoint& sample) const;

  const visibility::SceneFloats& scene_;
  const visibility::Light& light_;
  const Casters& casters_;
  LightOutline outline_;
  Arc arc_;
  std::optional<TextureWeights> texture_;
  glm::dvec2 lower_{-1}, upper_{1};  // bounds of the outline
  glm::vec3 center_{0};
  visibility::TriangleTree tree_;
  std::vector<std::uint32_t> caster_of_;                           // for each triangle of the scene: its caster
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_plane_;  // (plane, caster), sorted
  std::vector<mesh::Side> light_sides_;                            // see closed_casters.hpp
  std::vector<mesh::Side> center_facings_;                         // facings of the counted triangles
  std::vector<Silhouette> silhouettes_;
};

}  // namespace penumbra::volumes
