// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"
#include "volumes/raster/wedge_build.shared.h"

// Builds penumbra wedges of the construction `original` (Assarsson and Akenine-Möller 2003), one lane for each
// silhouette edge: the twin of original_planes (penumbra_wedge.cpp). Every plane in the result is proved: by the signs
// of bounds_penumbra, each beyond its error bound (docs/wedges.md, On the device). The host builds wedges without a
// proof.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Silhouettes { Silhouette silhouettes[]; };
layout(scalar, binding = 1) readonly buffer Ends { uvec2 ends[]; };  // ends of every edge
layout(scalar, binding = 2) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 3) readonly buffer Corners { dvec3 corners[]; };  // corners of the light's hull
layout(scalar, binding = 4) writeonly buffer Wedges { BuiltWedge wedges[]; };
layout(scalar, push_constant) uniform Push { WedgeBuildPush push; };

const double kProofError = 1.0LF / 562949953421312.0LF;  // 2⁻⁴⁹, relative to the sum of the terms' magnitudes
const double kLeast = 7.6e-37LF;                         // 2⁻¹²⁰: positions below 2⁻¹²⁶ may have been flushed to 0
const double kMostTurn = 1.0LF / 1048576.0LF;            // 2⁻²⁰, as in bounding_plane

double largest(dvec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

struct Sum {
  double value;
  double bound;  // upper bound of |exact − value|
};

/// Returns n · g + d, where g may be a difference of two doubles and d a product.
Sum sum_of(dvec3 n, dvec3 g, double d) {
  precise const dvec3 terms = n * g;
  precise const double value = terms.x + terms.y + terms.z + d;
  return Sum(value, kProofError * (abs(terms.x) + abs(terms.y) + abs(terms.z) + abs(d)) + kLeast);
}

struct Caster {
  dvec3 a, b;
  dvec3 away;  // a direction from the light to the edge, or an approximation
};

double least_direction(dvec3 m, Caster caster) {
  double least = min(dot(m, caster.a - corners[0]), dot(m, caster.b - corners[0]));
  for (uint i = 1; i < push.corner_count; ++i) {
    least = min(least, min(dot(m, caster.a - corners[i]), dot(m, caster.b - corners[i])));
  }
  return least;
}

/// Returns the direction along which edge and light are farther apart: the light's normal, or the direction to the
/// edge's nearest point. This is a heuristic; planes rotated toward it are proved afterwards.
dvec3 away_of(Caster caster) {
  const dvec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const dvec3 normal = across / length(across) * (dot(across, caster.a - corners[0]) < 0.0LF ? -1.0LF : 1.0LF);
  const dvec3 edge = caster.b - caster.a, from = caster.a - push.center;
  const dvec3 nearest = from + clamp(-dot(from, edge) / dot(edge, edge), 0.0LF, 1.0LF) * edge;
  const dvec3 toward = nearest / length(nearest);
  return least_direction(normal, caster) > least_direction(toward, caster) ? normal : toward;
}

/// Returns the multiple of `away` by which the normal must be rotated, so that no n · (x − l) is below twice its bound.
double turn_of(dvec3 n, Caster caster) {
  double turn = 0.0LF;
  for (uint i = 0; i < push.corner_count; ++i) {
    const dvec3 g = caster.a - corners[i], h = caster.b - corners[i];
    const Sum at_a = sum_of(n, g, 0.0LF), at_b = sum_of(n, h, 0.0LF);
    turn = max(turn, max((2.0LF * at_a.bound - at_a.value) / dot(caster.away, g),
                         (2.0LF * at_b.bound - at_b.value) / dot(caster.away, h)));
  }
  return turn;
}

bool is_proved(Sum sum) { return sum.value >= sum.bound; }  // false for NaN

/// Proves h(x) ≥ 0 and n · (x − l) ≥ 0 for both ends x and all corners l.
bool bounds_penumbra(dvec3 n, double d, Caster caster) {
  bool proved = is_proved(sum_of(n, caster.a, d)) && is_proved(sum_of(n, caster.b, d));
  for (uint i = 0; i < push.corner_count; ++i) {
    const dvec3 l = corners[i];
    proved = proved && is_proved(sum_of(n, caster.a - l, 0.0LF)) && is_proved(sum_of(n, caster.b - l, 0.0LF));
  }
  return proved;
}

/// Returns the normal of the plane that contains `at`, `direction` and a corner of the hull, and has no corner on its
/// positive side (tangent_normal in penumbra_wedge.cpp).
dvec3 tangent_normal(dvec3 at, dvec3 direction, double turn) {
  dvec3 extreme = turn * cross(direction, corners[0] - at);
  for (uint i = 1; i < push.corner_count; ++i) {
    const dvec3 g = corners[i] - at, normal = turn * cross(direction, g);
    if (dot(extreme, g) > 0.0LF) extreme = normal;
  }
  return extreme;
}

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const uvec2 edge_ends = ends[silhouettes[push.first + i].edge];
  Caster caster = Caster(dvec3(positions[edge_ends.x]), dvec3(positions[edge_ends.y]), dvec3(0.0LF));
  caster.away = away_of(caster);

  // Moves the farther end towards the light's centre, until both ends are equally far.
  const dvec3 c = push.center;
  const double to_a = length(caster.a - c), to_b = length(caster.b - c);
  const dvec3 a = to_a > to_b ? c + (caster.a - c) * (to_b / to_a) : caster.a;
  const dvec3 b = to_b > to_a ? c + (caster.b - c) * (to_a / to_b) : caster.b;

  bool proved = true;
  for (uint k = 0; k < kBuiltPlanes; ++k) {
    // Front and back contain the moved edge. Each side contains an end, and the direction that is orthogonal to the
    // edge and to the direction to the light. The other end is as far from c, so only one of the two tangents can have
    // it on its positive side.
    const dvec3 through = k == 3 ? b : a;
    const dvec3 direction = k < 2 ? b - a : cross(b - a, c - through);
    const dvec3 wanted = tangent_normal(through, direction, k == 0 || k == 3 ? 1.0LF : -1.0LF);
    dvec3 n = wanted / largest(wanted);
    const double turn = turn_of(n, caster);
    n += turn * caster.away;
    const Sum at_a = sum_of(n, caster.a, 0.0LF), at_b = sum_of(n, caster.b, 0.0LF);
    const double offset = -dot(n, through), least = max(-at_a.value, -at_b.value);
    const double reach = max(largest(caster.a), largest(caster.b));
    const double d = max(offset, least) + 4.0LF * (at_a.bound + at_b.bound + kProofError * abs(offset));
    // If a plane would have to be rotated or moved by more, it is not a plane of this wedge (as in bounding_plane).
    proved = proved && turn <= kMostTurn && least - offset <= kMostTurn * reach && bounds_penumbra(n, d, caster);
    wedges[i].planes[k] = BuiltPlane(n.x, n.y, n.z, d);
  }
  wedges[i].proved = proved ? 1 : 0;
}
