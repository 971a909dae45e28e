#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_view.shared.h"
#include "maps/host/view_fit.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// tan 76°: up to 152° wide a window of receivers has, texel for texel, about the resolution of a hemicube at a fifth
/// of its cost.
inline constexpr double kWidestTangent = 4;
/// Casters nearer to the light point than this share of the scene are not seen; see docs/accumulate.md.
inline constexpr float kNearOfFar = 0x1p-20f;

/// The views of several points of one light. All have the same faces, so that their maps are equally large.
struct FittedViews {
  std::vector<gpu::LightView> views;
  std::uint32_t faces = 0;  ///< of one light point: 0 … 10
};

struct FitOptions {
  std::uint32_t size = 0;  ///< texels on a side of a face
  /// How far beside a receiver's direction a look-up taps the map, in x/z and y/z: windows hold casters that far beside
  /// the receivers, too. Where there is no caster a tap beside the window finds nothing, and nothing is there.
  glm::dvec2 beside{0};
  /// For look-ups that ask for all that stands between a receiver and any point of the light: how far the light reaches
  /// from the point along u and v. Seen from the point, a caster at height z_c shades a receiver at height z from as
  /// far as reach · (1/z_c − 1/z) beside it: windows hold what casters are there, or become hemicubes.
  glm::dvec2 reach{0};
  /// What the camera sees takes the receivers' place. Null: all receivers.
  const std::vector<BodyPoint>* body = nullptr;
  /// With `body`: `beside` is no more than what casters that the light, reaching so far, can shade from; and texels lie
  /// where they lie for any body.
  glm::dvec2 body_reach{0};
  bool snap = false;
  bool hemicube = false;  ///< five faces, however narrow a window would do
};

/// FitOptions::reach of a light that is so large that every caster shades something.
glm::dvec2 reach_of_all(const visibility::SceneFloats& scene);

/// Fits each point's maps to the receivers of the scene, so that no receiver on an emitting side is ever outside.
/// Depends on mesh and light only, not on the camera, unless there is a body.
FittedViews fit_views(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                      std::span<const glm::vec3> points, const FitOptions& options);

/// How far beside what is at heights up to `deepest` over the light's plane a caster of this light can shade it, seen
/// from its centre: no farther than `beside`.
glm::dvec2 caster_margin(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                         double sign, const glm::dvec2& reach, double deepest);

/// One face: what lies at `point` + w · (x · a + y · b + axis w) has the coordinates x and y, from `lower` to `upper`.
struct Face {
  glm::dvec3 a, b, w;  ///< across, across and along; unit vectors in world axes
  glm::dvec2 lower, upper;

  /// To the centre of a texel, one long along the axis.
  [[nodiscard]] glm::dvec3 direction(std::uint32_t x, std::uint32_t y, std::uint32_t size) const {
    const glm::dvec2 at = lower + (glm::dvec2(x, y) + 0.5) * (upper - lower) / static_cast<double>(size);
    return at.x * a + at.y * b + w;
  }
};
Face face_of(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face);

/// What caster.vert needs for one face of a view; `first_vertex` is the caller's.
gpu::CasterPush face_push(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face);

}  // namespace penumbra::maps
