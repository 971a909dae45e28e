#pragma once

#include "maps/host/fitted_face.shared.h"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/view_fit.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// Faces of a light's centre that are windows or perspectives of what a camera sees. A ray through the light's centre
/// is a point of every one of them: whatever a warp is called, on rays it is a homography, and depths stay distances
/// from the light. docs/map-fits.md derives them.
namespace penumbra::maps {

struct FittedFace {
  int side = 0;               ///< of the light's plane
  int axis = 2;               ///< of the light's basis: along it depths are measured
  glm::dvec3 along{0, 0, 1};  ///< the same, with its sign; of e = (x, y, |z|)
  glm::dmat3 to_face{1};      ///< e to (a k, b k, k)
  double ratio = 0;           ///< LogPSM: rows are logarithms, of distances up to so many times the nearest; 0: none
  double margin = 0;          ///< of LogPSM: the share of the face on either side of its rows; of a circle: around it
  bool circle = false;        ///< e is seen where a paraboloid reflects it: a half space in a circle (paraboloid_face)
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< depths that ask it, from ≤ z < to

  /// Where a direction is seen, from 0 to 1 across the face; nothing if it is seen nowhere.
  [[nodiscard]] std::optional<glm::dvec2> place(const glm::dvec3& e) const;
  /// To a place, one long along the axis.
  [[nodiscard]] glm::dvec3 direction(const glm::dvec2& place) const;
  /// How a place changes, and where it is, as e moves.
  [[nodiscard]] glm::dvec2 moves(const glm::dvec3& e, const glm::dvec3& by) const;

  [[nodiscard]] gpu::FittedFace rounded() const;
};

/// Push constants of caster.vert or logarithmic.vert for a face; `first_vertex` is the caller's.
gpu::CasterPush face_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                          std::uint32_t size);
gpu::LogarithmicPush logarithmic_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                                      std::uint32_t size);

struct FaceFitOptions {
  ViewFit fit;
  std::uint32_t size = 0;
  std::uint32_t spare = 1;   ///< texels on every side, for what look-ups tap beside a receiver
  glm::dvec2 beside{0};      ///< FitOptions::beside
  glm::dvec2 body_reach{0};  ///< FitOptions::body_reach
};

/// Faces of the light's centre; those of the side where the light's normal points first.
std::vector<FittedFace> fit_faces(const visibility::SceneFloats& scene, const visibility::Light& light,
                                  const LightBasis& basis, const visibility::ViewSamples& samples,
                                  const FaceFitOptions& options);

/// All of a side of the light's plane, `spare` texels of `size` away from the face's sides: e is seen at (x, y) / (|e|
/// + z), on the unit disk (Brabec, Annen, Seidel 2002, "Shadow mapping for hemispherical and omnidirectional light
/// sources").
FittedFace paraboloid_face(int side, std::uint32_t size, std::uint32_t spare);

/// The faces that fit_views made, as such.
std::vector<FittedFace> faces_of(const gpu::LightView& view);

/// A receiver in the light's basis, seen from its centre.
struct SeenReceiver {
  int side = 0;
  glm::dvec3 e{0};
  double depth = 0;
};
std::optional<SeenReceiver> seen_receiver(const visibility::ViewSamples& samples, std::size_t pixel,
                                          const LightBasis& basis, bool both_sides);

/// The face that a receiver asks: the first that shows it.
const FittedFace* face_for(std::span<const FittedFace> faces, const SeenReceiver& receiver);

}  // namespace penumbra::maps
