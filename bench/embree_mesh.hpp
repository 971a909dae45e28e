// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to this room.

#include "mesh/triangle_soup.hpp"

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace penumbra::bench {

/// Returns Embree's hierarchy over one mesh, in robust mode, with positions minus `origin` as floats. The caller must
/// release it.
inline RTCScene robust_scene(RTCDevice device, const mesh::TriangleSoup& soup,
                             const glm::dvec3& origin = glm::dvec3(0)) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), soup.positions.size()));
  for (std::size_t i = 0; i < soup.positions.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      vertices[3 * i + axis] = static_cast<float>((soup.positions[i] - origin)[static_cast<int>(axis)]);
  auto* const corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), soup.triangles.size()));
  for (std::size_t i = 0; i < soup.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) corners[3 * i + k] = soup.triangles[i][k];
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

}  // namespace penumbra::bench
