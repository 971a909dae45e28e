// SPDX-License-Identifier: Apache-2.0
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

/// Faces of a light's centre that are windows or perspectives of the view of a camera. A ray through the light's centre
/// is one point of each face: every warp acts on rays as a homography, and depths stay distances from the light.
/// docs/map-fits.md derives the faces.
namespace penumbra::maps {

struct FittedFace {
  int side = 0;               ///< of the light's plane
  int axis = 2;               ///< axis of the light's basis along which depths are measured
  glm::dvec3 along{0, 0, 1};  ///< the same axis with its sign, for e = (x, y, |z|)
  glm::dmat3 to_face{1};      ///< maps e to (a k, b k, k); (a, b) is the position on the face
  double ratio = 0;           ///< LogPSM: rows are logarithms of distances up to `ratio` times the nearest; 0: linear
                              ///< rows
  double margin = 0;          ///< fraction of the face left free: for LogPSM on either side of its rows; for a circle,
                              ///< around the circle
  bool circle = false;        ///< e is projected by reflection at a paraboloid: a half space in a circle
                              ///< (paraboloid_face)
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< depths z of the receivers that use this face:
                                                                  ///< from ≤ z < to

  /// Returns the position of direction e, from 0 to 1 across the face; nullopt if the face does not contain e.
  [[nodiscard]] std::optional<glm::dvec2> place(const glm::dvec3& e) const;
  /// Returns the direction of a position, of length one along the axis.
  [[nodiscard]] glm::dvec3 direction(const glm::dvec2& place) const;
  /// Returns the displacement of a position when e moves by `by`.
  [[nodiscard]] glm::dvec2 moves(const glm::dvec3& e, const glm::dvec3& by) const;

  /// Returns the face in float32, as the device reads it.
  [[nodiscard]] gpu::FittedFace rounded() const;
};

/// Returns the push constants of caster.vert or logarithmic.vert for a face; the caller sets `first_vertex`.
gpu::CasterPush face_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                          std::uint32_t size);
gpu::LogarithmicPush logarithmic_push(const FittedFace& face, const gpu::LightView& view, const LightBasis& basis,
                                      std::uint32_t size);

struct FaceFitOptions {
  ViewFit fit;
  std::uint32_t size = 0;
  std::uint32_t spare = 1;   ///< texels on every side, for taps of look-ups around a receiver
  glm::dvec2 beside{0};      ///< FitOptions::beside
  glm::dvec2 body_reach{0};  ///< FitOptions::body_reach
  SceneSpace space = {};
};

/// Returns the faces of the light's centre; first those of the side where the light's normal points.
std::vector<FittedFace> fit_faces(const visibility::SceneFloats& scene, const visibility::Light& light,
                                  const LightBasis& basis, const visibility::ViewSamples& samples,
                                  const FaceFitOptions& options);

/// Returns a square of the quadtree over a face: 2^level squares across. `first`: number of squares before
/// it on each axis.
FittedFace square_of(const FittedFace& whole, std::uint32_t level, const glm::dvec2& first);

/// Returns the face of a whole side of the light's plane, `spare` texels of `size` away from the face's sides: e is
/// projected to (x, y) / (|e| + z), on the unit disk (Brabec, Annen, Seidel 2002, "Shadow mapping for hemispherical and
/// omnidirectional light sources").
FittedFace paraboloid_face(int side, std::uint32_t size, std::uint32_t spare);

/// Returns the faces made by fit_views, as FittedFace.
std::vector<FittedFace> faces_of(const gpu::LightView& view);

/// Receiver in the light's basis, seen from the light's centre.
struct SeenReceiver {
  int side = 0;
  glm::dvec3 e{0};
  double depth = 0;
};
std::optional<SeenReceiver> seen_receiver(const visibility::ViewSamples& samples, std::size_t pixel,
                                          const LightBasis& basis, bool both_sides, const SceneSpace& space = {});

/// Returns the face used by a receiver: the first that contains the receiver; nullptr if there is none.
const FittedFace* face_for(std::span<const FittedFace> faces, const SeenReceiver& receiver);

}  // namespace penumbra::maps
