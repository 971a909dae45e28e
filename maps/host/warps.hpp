// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/view_fit.hpp"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

/// The warps of Eisemann et al. 2009, section 3.2.2, as homographies of a face's plane.
namespace penumbra::maps {

/// Camera and its visible points, in coordinates (a, b, w) of a face, with the light's centre at 0.
struct SeenBody {
  std::span<const glm::dvec3> points;  ///< w > 0
  double near = 0, far = 0;            ///< depths of the points along the view axis, near > 0
  glm::dvec3 eye{0}, forward{0};
  glm::dvec3 across{0}, upward{0};  ///< screen_across, screen_upward
  bool perspective = true;          ///< false: an orthographic camera, without a perspective
};

/// Homography from (a, b, w) to (a' k, b' k, k) with k > 0 at all points.
struct Warp {
  glm::dmat3 matrix{1};
  double ratio = 0;  ///< logpsm: distance of the farthest point from the eye, divided by that of the nearest; b' runs
                     ///< from 0 to 1
};

/// Returns the warp; the identity where a warp has no effect: if the view is along the light's rays, and for logpsm if
/// the eye, seen from the light, is above the visible points. `focus`: ViewFit::focus.
Warp warp_of(Fit fit, const SeenBody& body, double focus);

/// A face of the camera's frustum, seen from the light's centre: the homography from the directions of rays that leave
/// the frustum through the face to the camera's image of the face, [−1, 1]². The image's coordinates on a side of the
/// frustum are the position along the picture's border and the inverse of the depth; on the near and the far end, the
/// position in the picture.
struct FrustumFace {
  glm::dmat3 matrix{1};

  /// Returns how far outside of [−1, 1]² the point is seen, at most 0 inside; infinite if not in front of the light.
  [[nodiscard]] double beyond(const glm::dvec3& point) const;
};

/// Returns the faces of the frustum from body.near to body.far through which rays from the light's centre leave the
/// frustum: those with the light on their inner side. The frustum is convex, so each ray leaves through one of them.
/// Empty for an orthographic camera.
std::vector<FrustumFace> frustum_faces(const SeenBody& body);

/// Returns whether float32 suffices for the homography at these points.
bool is_moderate(const glm::dmat3& matrix, std::span<const glm::dvec3> points);

}  // namespace penumbra::maps
