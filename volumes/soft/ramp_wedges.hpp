// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

/// The penumbra wedges of Akenine-Möller and Assarsson 2002: front and back contain the edge and touch the light; sides
/// are shared by the wedges of neighbouring edges and contain the line from the light's centre through their common
/// end. So wedges are adjacent and do not overlap, unless silhouettes do. They bound no penumbra; points inside get a
/// linear ramp from front to back.
///
/// Where two silhouette edges of equal |k| meet at no more than about a right angle, their side bisects the planes (c,
/// edge); elsewhere it is orthogonal to the edge's own plane.
namespace penumbra::volumes {

/// Planes of a wedge, in this order, with unit normals: if p is on the positive side of (c, a, b), light past `front`
/// is completely visible as far as this edge is concerned; if p is on the negative side, light past `back` is hidden,
/// for k > 0.
enum RampPlane : std::size_t { kFront = 0, kBack = 1, kSideA = 2, kSideB = 3 };
inline constexpr std::size_t kRampPlanes = 4;

/// Returns a wedge for each edge; it is `empty` if the edge's line meets the light, so that no plane through the edge
/// touches the light: the shadow is hard there.
LightWedges ramp_wedges_of(const LightVolumes& volumes, const visibility::Light& light);

/// Returns the edges' contribution at p to the count at c: k times the ramp or, on the negative side, the ramp minus 1.
/// The C++ twin of wedge_ramp.frag; ties of the side are resolved as in docs/definitions.md.
double ramp_sum(const LightWedges& wedges, const visibility::Light& light, const glm::vec3& p);

/// Returns the shader's data: four coefficients for each plane, four planes for each edge.
std::vector<double> ramp_words(const LightWedges& wedges);

}  // namespace penumbra::volumes
