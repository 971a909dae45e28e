// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/surface_alpha.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::visibility {

using Triangle = mesh::Triangle;

/// The one set of numbers that device, rays, predicates and oracles share: float32 of (world − origin), where origin is
/// the centre of the bounding box of all mesh vertices at rest (Scene::origin), in double. So precision does not depend
/// on a scene's position or size.
struct SceneFloats {
  glm::dvec3 origin{0};
  std::vector<glm::vec3> positions;   ///< one for each soup position
  std::vector<Triangle> triangles;    ///< soup order; each with its vertices in lexicographic order of position (−0 =
                                      ///< +0), so that no value computed from them depends on winding or first vertex
  std::vector<std::uint32_t> object;  ///< for each triangle
  std::vector<std::uint32_t> plane;   ///< for each triangle: equal numbers ⇔ exactly coplanar (kNoPlane: zero area)
  std::vector<std::uint8_t> casts_shadow;     ///< for each triangle: false for objects that cast no shadows, for
                                              ///< zero-area triangles, and for those that let light through (`alphas`)
  std::vector<std::uint8_t> receives_shadow;  ///< for each triangle
  std::vector<std::int32_t> emits;            ///< for each triangle: the light whose body it is, or −1
  glm::vec3 lower{0}, upper{0};               ///< bounding box of positions
  SurfaceAlphas alphas;                       ///< surfaces with holes and translucent ones

  static constexpr std::uint32_t kNoPlane = 0xffffffffu;

  [[nodiscard]] std::array<glm::vec3, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
  /// Returns whether the sorted vertices of the first triangle are strictly before the other's in lexicographic order.
  /// At equal t, the triangle that comes first in this order carries a view sample.
  [[nodiscard]] bool comes_before(std::uint32_t triangle, std::uint32_t other) const;
};

/// Makes scene floats. Throws InputError when a position, relative to the origin, is not finite in float32, or when the
/// whole scene is so small that float32 loses precision.
SceneFloats make_scene_floats(const scenes::Scene& scene);

/// Returns for each triangle its place in the order of comes_before(); triangles with the same three vertices share
/// one.
std::vector<std::uint32_t> ranks(const SceneFloats& scene);

struct Light;
/// Returns the scene with only those casters that cast shadows of this light (Light::unshaded_by).
SceneFloats cast_for(const SceneFloats& scene, const Light& light);

}  // namespace penumbra::visibility
