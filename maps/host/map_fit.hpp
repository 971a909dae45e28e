// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_view.shared.h"
#include "maps/host/view_fit.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// tan 76°: a window of receivers up to 152° wide has, for the same number of texels, about the resolution of a
/// hemicube at a fifth of its cost.
inline constexpr double kWidestTangent = 4;
/// Near plane as a fraction of the far one: casters nearer to the light point are not seen; see docs/accumulate.md.
inline constexpr float kNearOfFar = 0x1p-20f;

/// Views of several points of one light. All have the same faces, so that their maps have the same size.
struct FittedViews {
  std::vector<gpu::LightView> views;
  std::uint32_t faces = 0;  ///< of one light point: 0 … 10
};

struct FitOptions {
  std::uint32_t size = 0;  ///< on a side of a face, in texels
  /// Largest distance of a look-up's taps from a receiver's direction, in x/z and y/z: windows also hold casters up to
  /// this distance from the receivers. Where there is no caster, a tap outside the window returns an empty texel, which
  /// is correct.
  glm::dvec2 beside{0};
  /// For look-ups of all occluders between a receiver and any point of the light: extent of the light from the point
  /// along u and v. Seen from the point, a caster at height z_c shades a receiver at height z up to a distance of reach
  /// · (1/z_c − 1/z) from the receiver: windows hold these casters, or become hemicubes.
  glm::dvec2 reach{0};
  /// Points seen by the camera, in place of the receivers. Null: all receivers.
  const std::vector<BodyPoint>* body = nullptr;
  /// With `body`: extent of the light; `beside` is limited to the distance from which a caster can shade a receiver
  /// under such a light. `snap` keeps texels at the same positions for any body.
  glm::dvec2 body_reach{0};
  bool snap = false;
  /// All triangles, if the scene has only some of them; null: the scene has all. Only for maps of one point of a planar
  /// light, fitted to the receivers.
  const visibility::AllTriangles* all = nullptr;
  bool hemicube = false;  ///< five faces, even if a window would suffice
  glm::dvec2 jitter{0};   ///< displacement of windows in texels, at most a half; the contents stay inside the window
};

/// Returns FitOptions::reach of a light so large that every caster shades something.
glm::dvec2 reach_of_all(const visibility::SceneFloats& scene);

/// Fits each point's maps to the receivers of the scene, so that no receiver on an emitting side is ever outside.
/// Depends on mesh and light only, not on the camera, unless there is a body.
FittedViews fit_views(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                      std::span<const glm::vec3> points, const FitOptions& options);

/// Returns the largest distance, at most `beside`, from a receiver's direction at which a caster of this light can
/// shade the receiver, seen from the light's centre, for receivers at heights up to `deepest` over the light's plane.
glm::dvec2 caster_margin(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                         double sign, const glm::dvec2& reach, double deepest);

/// Face of a map: the point `point` + w · (x · a + y · b + axis w) has the coordinates x and y, from `lower` to
/// `upper`.
struct Face {
  glm::dvec3 a, b, w;  ///< across, across and along; unit vectors in world axes
  glm::dvec2 lower, upper;

  /// Returns the direction of the centre of a texel, of length one along the axis.
  [[nodiscard]] glm::dvec3 direction(std::uint32_t x, std::uint32_t y, std::uint32_t size) const {
    const glm::dvec2 at = lower + (glm::dvec2(x, y) + 0.5) * (upper - lower) / static_cast<double>(size);
    return at.x * a + at.y * b + w;
  }
};
Face face_of(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face);

/// Returns the push constants of caster.vert for one face of a view; the caller sets `first_vertex`.
gpu::CasterPush face_push(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face);

}  // namespace penumbra::maps
