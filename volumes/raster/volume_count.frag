// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/determinant.glsl"

// Decides whether the ray from p away from the eye (z-fail), or the segment from the eye to p (z-pass), meets this face
// of shadow volumes, and whether it enters or leaves them there. Signs of determinants in double must all agree for
// that; volumes/README.md, Counting, derives them. Where the result depends on a sign that may be due to rounding, the
// pixel is marked and the host counts.
//
// P, A, B: p, a, b relative to l.  D: p relative to the eye.  (x, y, z): their determinant.

layout(constant_id = 0) const uint kFace = 0;   // 0: side, 1: fan at infinity, 2: cap, 3: fan at lower, 4: at upper
layout(constant_id = 1) const uint kZPass = 0;
layout(constant_id = 2) const uint kParts = 0;  // 1: faces belong to parts, whose bounds apply

layout(scalar, binding = 0) readonly buffer Faces { VolumeFace faces[]; };  // used by the vertex shader; both stages
                                                                            // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { VolumeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Counts { int counts[]; };
layout(scalar, binding = 3) buffer Doubts { uint doubts[]; };  // kDoubtBit; below it, the number of changes of the
                                                               // pixel's count
layout(scalar, binding = 4) readonly buffer Parts { VolumePart parts[]; };
layout(scalar, push_constant) uniform Push { VolumePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in vec3 face_c;
layout(location = 3) flat in int face_weight;
layout(location = 4) flat in uint face_plane;
layout(location = 5) flat in uint face_part;

Value negative(Value v) { return Value(-v.value, v.bound); }
Value difference(Value v, Value w) { return Value(v.value - w.value, v.bound + w.bound); }
Value sum(Value v, Value w) {
  precise const double value = v.value + w.value;
  return Value(value, v.bound + w.bound + kDeterminantError * (abs(v.value) + abs(w.value)));
}
Value product(Value v, Value w) {
  precise const double value = v.value * w.value;
  return Value(value, abs(v.value) * w.bound + abs(w.value) * v.bound + v.bound * w.bound + kDeterminantError * abs(value));
}
Value along(dvec3 n, dvec3 x) {
  precise const double value = n.x * x.x + n.y * x.y + n.z * x.z;
  return Value(value, kDeterminantError * norm1(n) * norm1(x));
}

const uint kUp = 1, kDown = 2, kDoubt = 4;

uint signs(Value v) { return v.value > v.bound ? kUp : v.value < -v.bound ? kDown : kDoubt; }

/// Returns 1 or −1 if all signs agree; 0 if they differ; kUnknown if that depends on a doubtful sign.
const int kUnknown = 2;
int agreement(uint seen) {
  if ((seen & (kUp | kDown)) == (kUp | kDown)) return 0;
  if ((seen & kDoubt) != 0) return kUnknown;
  return seen == kUp ? 1 : -1;
}

/// Returns whether faces on the segment from the eye to p count, not those on the ray beyond p. The same for all faces
/// of a part.
bool counts_before(dvec3 P) {
  if (kParts == 0 || (parts[face_part].bounds & kToggles) == 0) return kZPass != 0;
  precise const dvec3 b = parts[face_part].barrier * P;
  precise const double height = b.x + b.y + b.z;
  return height > 0.0LF;
}

/// The ray meets a side at P − (f / h) d. Returns signs that equal h's if this point is between the planes of the
/// side's part.
uint between_planes(dvec3 P, dvec3 d, Value h, Value f) {
  if (kParts == 0) return 0;
  const uint bounds = parts[face_part].bounds;
  if ((bounds & (kHasLower | kHasUpper)) == 0) return 0;
  const dvec3 n = parts[face_part].axis;
  const Value at = along(n, P), direction = product(along(n, d), f);
  uint seen = 0;
  if ((bounds & kHasUpper) != 0) {
    seen |= signs(sum(product(sum(Value(parts[face_part].upper, 0.0LF), negative(at)), h), direction));
  }
  if ((bounds & kHasLower) != 0) {
    seen |= signs(sum(product(sum(at, Value(-parts[face_part].lower, 0.0LF)), h), negative(direction)));
  }
  return seen;
}

/// Returns the contribution of a side: +1 where the ray leaves the volumes of multiplicity 1, −1 where it enters.
int side(dvec3 p, dvec3 d, dvec3 l, dvec3 a, dvec3 b) {
  const dvec3 P = p - l, A = a - l, B = b - l;
  const Value h = det(A, B, d), f = det(A, B, P);
  uint seen = signs(h) | signs(det(P, d, A)) | signs(negative(det(P, d, B))) | signs(negative(det(d, a - p, b - p)));
  seen |= between_planes(P, d, h, f);
  if (!counts_before(P)) return agreement(seen | signs(negative(f)));
  const int direction = agreement(seen | signs(f) | signs(difference(h, f)));
  return direction == kUnknown ? kUnknown : -direction;
}

/// Returns the contribution of an edge's fan at infinity.
int fan(dvec3 P, dvec3 d, dvec3 l, dvec3 apex, dvec3 a, dvec3 b) {
  if (counts_before(P)) return 0;
  const dvec3 A = a - l, B = b - l;
  const int direction =
      agreement(signs(det(apex, A, B)) | signs(det(d, A, B)) | signs(det(apex, d, B)) | signs(det(apex, A, d)));
  return direction == kUnknown ? kUnknown : -direction;
}

/// Returns the contribution of an edge's fan in the plane n · x = offset. The ray beyond p meets that plane at Q = (r P
/// + g d) / r.
int fan_in_plane(dvec3 P, dvec3 d, dvec3 l, double offset, dvec3 a, dvec3 b) {
  const dvec3 A = a - l, B = b - l, n = parts[face_part].axis;
  const Value r = along(n, d), g = sum(Value(offset, 0.0LF), negative(along(n, P)));
  const int ahead = agreement(signs(r) | signs(g));
  if (ahead == 0 || ahead == kUnknown) return ahead;
  const Value rr = ahead > 0 ? r : negative(r), gg = ahead > 0 ? g : negative(g);
  const int direction = agreement(signs(det(n, A, B)) | signs(sum(product(det(P, A, B), rr), product(det(d, A, B), gg))) |
                            signs(sum(product(det(n, P, B), rr), product(det(n, d, B), gg))) |
                            signs(sum(product(det(n, A, P), rr), product(det(n, A, d), gg))));
  return direction == kUnknown ? kUnknown : -direction * ahead;
}

uint passes(dvec3 p, dvec3 d, dvec3 a, dvec3 b, dvec3 c) {
  return signs(det(d, a - p, b - p)) | signs(det(d, b - p, c - p)) | signs(det(d, c - p, a - p));
}

int cap(dvec3 p, dvec3 d, dvec3 l, dvec3 a, dvec3 b, dvec3 c) {
  const Value height = det(b - a, c - a, p - a);
  uint seen = passes(p, d, a, b, c);
  if (!counts_before(p - l)) return agreement(seen | signs(negative(height)));
  const Value fall = det(b - a, c - a, d);
  const int direction = agreement(seen | signs(height) | signs(difference(fall, height)));
  return direction == kUnknown ? kUnknown : -direction;
}

/// Returns the contribution of a cap on the carrier's plane: cancels its volume, regardless of the side of the plane
/// that p was rounded to.
int coplanar_cap(dvec3 p, dvec3 d, dvec3 l, dvec3 a, dvec3 b, dvec3 c) {
  const int eye = agreement(passes(p, d, a, b, c)), light = agreement(passes(p, p - l, a, b, c));
  const uint fall = signs(det(b - a, c - a, d)), height = signs(det(b - a, c - a, p - a));
  if (eye == 0 && light == 0) return 0;
  if (eye == kUnknown || light == kUnknown || fall != kDown) return kUnknown;
  const int from_eye = abs(eye), from_light = abs(light);
  if (from_eye != from_light && height == kDoubt) return kUnknown;
  if (!counts_before(p - l)) return height == kDown ? -from_light : -from_eye;
  return height == kDown ? from_eye - from_light : 0;
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const VolumeReceiver receiver = receivers[slot];
  if (receiver.plane == kNotCounted) return;
  const dvec3 p = dvec3(receiver.p), l = dvec3(push.l), a = dvec3(face_a), b = dvec3(face_b), c = dvec3(face_c);
  precise const dvec3 d = p - push.eye;
  int change = 0;
  if (kFace == 0) {
    change = side(p, d, l, a, b);
  } else if (kFace == 1) {
    change = fan(p - l, d, l, push.apex, a, b);
  } else if (kFace == 3) {
    change = fan_in_plane(p - l, d, l, parts[face_part].lower, a, b);
    change = change == kUnknown ? kUnknown : -change;
  } else if (kFace == 4) {
    change = fan_in_plane(p - l, d, l, parts[face_part].upper, a, b);
  } else if (face_plane == receiver.plane) {
    change = coplanar_cap(p, d, l, a, b, c);
  } else {
    change = cap(p, d, l, a, b, c);
  }
  if (change == kUnknown) {
    atomicOr(doubts[slot], kDoubtBit);
  } else if (change != 0) {
    atomicAdd(counts[slot], change * face_weight);
    atomicAdd(doubts[slot], 1u);
  }
}
