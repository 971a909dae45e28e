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

/// A view sample, as ViewSamples stores it.
struct LitPoint {
  glm::vec3 p{0};
  std::uint32_t carrier = 0;
  std::int8_t facing = 0;
};

/// Whose silhouettes are added up.
enum class Viewer {
  center,    ///< k_e(c), one set for all view samples: the method
  receiver,  ///< k_e(p): the layers as they are
};

/// An edge that takes from the light, or gives back to it, as a view sample sees it.
struct CoveredEdge {
  std::uint32_t edge = 0;         ///< of the casters' graph
  std::int32_t multiplicity = 0;  ///< k_e of what counts, never 0 (closed_casters.hpp)
  std::int8_t side = 0;           ///< +1: the clipped edge turns counter-clockwise around the reference point. Exact
  ClippedEdge clipped;            ///< in frame coordinates
  double area = 0;                ///< what it adds to `blocked`: ± k_e times the area beyond it, of |L|, or its weight
};

struct LayerSum {
  bool in_front = false;       ///< of the light; if not, nothing else is set, and V = 0
  glm::vec3 reference{0};      ///< the point of the light that areas are seen from: its centre, unless edges end there
  glm::dvec2 reference_at{0};  ///< the reference point in frame coordinates
  bool moved = false;          ///< it is not the centre
  std::int32_t constant = 0;   ///< layers at the reference point. Exact
  std::vector<CoveredEdge> edges;  ///< by their numbers; those that appear on the light
  double sum = 0;                  ///< of their areas
  double blocked = 0;              ///< constant + sum: the mean number of layers over the light
  double above = 1;                ///< share of the light above the carrier's plane
  double visibility = 0;           ///< 1 − blocked, but not below 0 nor beyond `above`
};

/// Soft shadow volumes (Assarsson and Akenine-Möller 2003) at one view sample: the plain C++ twin of the method
/// `soft-volume`, for rectangle, convex polygon and disk lights; and for spheres, each p with the disk that it sees.
/// docs/coverage.md derives it.
///
/// A textured light weighs: in place of |L| and areas stand the integral of its luminance and the shares of that.
/// `above` stays a share of |L|, as in the method.
///
/// With D(l) the number of layers between p and the light point l, `blocked` is its mean over the light. From the
/// receiver's own silhouettes D counts the triangles that p→l meets (of closed parts half of them: closed_casters.hpp),
/// and `blocked` is the hidden share where no layers overlap. From the centre's, a triangle that has p and c on one
/// side counts −1: there the method approximates.
///
/// What is coplanar with the carrier does not count, nor does a triangle that touches p. D at the reference point and
/// the side of every edge are exact, ties read as docs/definitions.md says, so that nothing jumps by a whole light.
class SoftVisibility {
 public:
  /// Borrows all three; `casters` are casters_of(scene, light). ResourceError: a texture too large (TextureWeights).
  SoftVisibility(const visibility::SceneFloats& scene, const visibility::Light& light, const Casters& casters,
                 Arc arc = Arc::tangent);

  [[nodiscard]] LayerSum at(const LitPoint& sample, Viewer viewer) const;

  /// Edges of what counts, with their k_e, by number.
  using Silhouette = std::pair<std::uint32_t, std::int32_t>;
  /// As at() with Viewer::center, in parts. Edges may be left out that do not appear on the light.
  struct CenterCount {
    std::optional<std::int32_t> layers = {};  ///< at the light's centre, if they are counted already
    bool at_most_one = false;                 ///< however many there are
  };
  [[nodiscard]] LayerSum at_center(const LitPoint& sample, std::span<const Silhouette> edges,
                                   const CenterCount& count) const;
  /// k_e(c) ≠ 0, the same for all view samples.
  [[nodiscard]] const std::vector<Silhouette>& silhouettes_of_center() const { return silhouettes_; }
  [[nodiscard]] bool may_appear(const LightProjection& from, std::uint32_t edge) const;
  /// Does one of the scene's triangles count as a layer at the light's centre, and what does it add there for a view
  /// sample?
  [[nodiscard]] bool counts_at_center(std::uint32_t triangle) const;
  [[nodiscard]] std::int32_t layer_at_center(const LitPoint& sample, std::uint32_t triangle) const {
    return layer_of(triangle, sample, center_, Viewer::center);
  }

  /// The triangles that count for the receiver and may appear on its light: of the layers, each by itself
  /// (layer_areas.hpp makes `blocked` of them without edges).
  [[nodiscard]] std::vector<std::array<glm::vec3, 3>> layers(const LitPoint& sample) const;

  /// Does any caster meet the light itself? No edge tells where its shadow ends there, and no sum is exact.
  [[nodiscard]] bool something_touches_light() const;

  [[nodiscard]] const LightOutline& outline() const { return outline_; }
  /// None: all of the light weighs the same.
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
  glm::dvec2 lower_{-1}, upper_{1};  // of the outline
  glm::vec3 center_{0};
  visibility::TriangleTree tree_;
  std::vector<std::uint32_t> caster_of_;                           // for each of the scene's triangles
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_plane_;  // plane, caster; sorted
  std::vector<mesh::Side> light_sides_;                            // closed_casters.hpp
  std::vector<mesh::Side> center_facings_;                         // of what counts
  std::vector<Silhouette> silhouettes_;
};

}  // namespace penumbra::volumes
