// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/predicates.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace penumbra::visibility {

using mesh::collinear, mesh::coplanar, mesh::Side, mesh::side_of_direction, mesh::side_of_plane;

/// Result of an exact segment–triangle test, and whether some predicate was exactly zero.
struct Meeting {
  bool meets = false;
  bool zero_predicate = false;  ///< an edge sign or a plane side was exactly zero (and resolved as defined), and the
                                ///< signs that are not zero do not already decide that the line misses the triangle
};

/// In all functions below, for a sun l is a direction: the segment is the ray p + t · l, t > 0, and l − p stands for l.
///
/// Returns the side of the line p→l on which the edge a→b passes: the sign of det(l − p, a − p, b − p), resolved as in
/// docs/definitions.md where that is zero, so that neighbouring triangles agree about their edge. 0 only if p is on the
/// line a b or on the light's plane. Exact.
int edge_side(const glm::vec3& p, const glm::vec3& l, const glm::vec3& a, const glm::vec3& b, const Light& light);

/// Returns whether the open segment p→l meets the triangle. Exact. An edge sign that is zero is resolved as that of l +
/// ε(u) + ε²(v), with u, v the light's frame axes; zero-area triangles, and triangles whose plane contains p or l, are
/// not met. Ignores carriers: the caller handles coplanar triangles.
Meeting segment_meets_triangle(const glm::vec3& p, const glm::vec3& l, const std::array<glm::vec3, 3>& corners,
                               const Light& light);

/// The point centre + s u + t v of a light's plane, exact for the stored points. Not for a sphere or sun.
struct PlanePoint {
  PlanePoint(const Light& light, const glm::dvec2& at);

  glm::dvec2 st{0};
  glm::dvec3 rounded{0};  ///< the point, rounded to double
  double off = 0;         ///< upper bound of its distance from the exact point
};

/// Returns whether a part of the triangle strictly between p and the light's plane meets the segment from p to exactly
/// this point. Exact; zeros are resolved as in segment_meets_triangle.
bool meets_before_light(const glm::vec3& p, const PlanePoint& l, const std::array<glm::vec3, 3>& corners,
                        const Light& light);

enum class PairOutcome : std::uint8_t {
  visible,
  blocked,  ///< some triangle meets the open segment
  horizon,  ///< l is not strictly on the viewer's side of the carrying triangle's plane
  behind,   ///< p is not strictly on an emitting side of the light
};

struct PairTruth {
  PairOutcome outcome = PairOutcome::visible;
  bool zero_predicate = false;
  bool by_mask = false;  ///< decided by the texels of a surface with holes: no opaque surface is between p and l
};

/// Returns condition (1): l strictly on the viewer's side of the carrier's plane; `facing` is ViewSamples::facing (+1:
/// the viewer is on the side that (b − a) × (c − a) points to, −1: behind). Exact.
bool above_horizon(const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const glm::vec3& l);
/// Returns condition (1) for any light's points, including a sun's directions.
bool above_horizon(const Light& light, const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const glm::vec3& l);

/// Returns condition (2): p strictly on an emitting side of the light's plane; for a sphere, strictly outside it;
/// always true for a sun. Exact.
bool in_front_of_light(const Light& light, const glm::vec3& p);

/// Returns whether this triangle can hide the light from a view sample on `carrier`: it casts shadows, has an area, is
/// not coplanar with the carrier, and is not the body of the light itself.
inline bool may_occlude(const SceneFloats& scene, const Light& light, std::uint32_t carrier, std::uint32_t triangle) {
  return scene.casts_shadow[triangle] != 0 && scene.plane[triangle] != scene.plane[carrier] &&
         scene.emits[triangle] != light.index;
}

/// Returns whether a triangle that lets light through (SurfaceAlphas::casters) can attenuate the light.
inline bool may_filter(const SceneFloats& scene, const Light& light, std::uint32_t carrier, std::uint32_t triangle) {
  return scene.plane[triangle] != scene.plane[carrier] && scene.emits[triangle] != light.index;
}

/// Returns the truth of a pair (docs/definitions.md): the final oracle. Tests every triangle whose box the segment's
/// box touches: microseconds per thousand triangles; for hundreds of pairs, not for images. `pixel` must not be
/// background.
PairTruth decide_pair(const SceneFloats& scene, const ViewSamples& samples, std::size_t pixel, const Light& light,
                      std::uint32_t light_sample);

}  // namespace penumbra::visibility
