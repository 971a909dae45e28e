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
/// are shared by the wedges of neighbouring edges and hold the line from the light's centre through their common end.
/// So wedges stand side by side and do not overlap, unless silhouettes do. They bound no penumbra; what is in one gets
/// a linear ramp from front to back.
///
/// Where two silhouette edges of equal |k| meet at no more than about a right angle, their side bisects the planes (c,
/// edge); elsewhere it is at a right angle to the edge's own.
namespace penumbra::volumes {

/// Planes of a wedge, in this order, with unit normals: where p is on the positive side of (c, a, b) light is past
/// `front` all visible, as far as this edge goes; on the negative side likewise past `back` hidden, for k > 0.
enum RampPlane : std::size_t { kFront = 0, kBack = 1, kSideA = 2, kSideB = 3 };
inline constexpr std::size_t kRampPlanes = 4;

/// One wedge an edge; `empty` where the edge's line meets the light, so that no planes touch it: the shadow is hard
/// there.
LightWedges ramp_wedges_of(const LightVolumes& volumes, const visibility::Light& light);

/// What the edges add to the count at c, at p: k times the ramp or, on the negative side, the ramp less 1. The C++ twin
/// of wedge_ramp.frag; ties of the side as docs/definitions.md reads them.
double ramp_sum(const LightWedges& wedges, const visibility::Light& light, const glm::vec3& p);

/// What the shader reads: four coefficients a plane, four planes an edge.
std::vector<double> ramp_words(const LightWedges& wedges);

}  // namespace penumbra::volumes
