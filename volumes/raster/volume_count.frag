#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/determinant.glsl"

// Where does the ray from p away from the eye (z-fail), or the segment from the eye to p (z-pass), go through this face
// of shadow volumes, and in or out? Signs of determinants in double that must all be one sign; volumes/README.md, Counting,
// derives which. Where it depends on a sign that may be due to rounding, the pixel is marked and the host counts.
//
// P, A, B: p, a, b from l.  D: p from the eye.  (x, y, z): their determinant.

layout(constant_id = 0) const uint kFace = 0;   // 0: side, 1: fan at infinity, 2: cap
layout(constant_id = 1) const uint kZPass = 0;

layout(scalar, binding = 0) readonly buffer Faces { VolumeFace faces[]; };  // the vertex shader's; one set for both
layout(scalar, binding = 1) readonly buffer Receivers { VolumeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Counts { int counts[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, push_constant) uniform Push { VolumePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in vec3 face_c;
layout(location = 3) flat in int face_weight;
layout(location = 4) flat in uint face_plane;

Value negative(Value v) { return Value(-v.value, v.bound); }
Value difference(Value v, Value w) { return Value(v.value - w.value, v.bound + w.bound); }

const uint kUp = 1, kDown = 2, kDoubt = 4;

uint signs(Value v) { return v.value > v.bound ? kUp : v.value < -v.bound ? kDown : kDoubt; }

/// 1 or −1 if all are that sign; 0 if they differ; kUnknown if that depends on a doubtful sign.
const int kUnknown = 2;
int agreement(uint seen) {
  if ((seen & (kUp | kDown)) == (kUp | kDown)) return 0;
  if ((seen & kDoubt) != 0) return kUnknown;
  return seen == kUp ? 1 : -1;
}

/// What a side adds: +1 where the ray leaves the volumes of multiplicity 1, −1 where it enters.
int side(dvec3 p, dvec3 d, dvec3 l, dvec3 a, dvec3 b) {
  const dvec3 P = p - l, A = a - l, B = b - l;
  const Value h = det(A, B, d), f = det(A, B, P);
  uint seen = signs(h) | signs(det(P, d, A)) | signs(negative(det(P, d, B))) | signs(negative(det(d, a - p, b - p)));
  if (kZPass == 0) return agreement(seen | signs(negative(f)));
  const int way = agreement(seen | signs(f) | signs(difference(h, f)));
  return way == kUnknown ? kUnknown : -way;
}

/// What the fan of an edge at infinity adds.
int fan(dvec3 d, dvec3 l, dvec3 apex, dvec3 a, dvec3 b) {
  const dvec3 A = a - l, B = b - l;
  const int way =
      agreement(signs(det(apex, A, B)) | signs(det(d, A, B)) | signs(det(apex, d, B)) | signs(det(apex, A, d)));
  return way == kUnknown ? kUnknown : -way;
}

uint passes(dvec3 p, dvec3 d, dvec3 a, dvec3 b, dvec3 c) {
  return signs(det(d, a - p, b - p)) | signs(det(d, b - p, c - p)) | signs(det(d, c - p, a - p));
}

int cap(dvec3 p, dvec3 d, dvec3 a, dvec3 b, dvec3 c) {
  const Value height = det(b - a, c - a, p - a);
  uint seen = passes(p, d, a, b, c);
  if (kZPass == 0) return agreement(seen | signs(negative(height)));
  const Value fall = det(b - a, c - a, d);
  const int way = agreement(seen | signs(height) | signs(difference(fall, height)));
  return way == kUnknown ? kUnknown : -way;
}

/// A cap on the carrier's plane: adds what makes its volume count nothing, whichever side of the plane p was rounded to.
int coplanar_cap(dvec3 p, dvec3 d, dvec3 l, dvec3 a, dvec3 b, dvec3 c) {
  const int eye = agreement(passes(p, d, a, b, c)), light = agreement(passes(p, p - l, a, b, c));
  const uint fall = signs(det(b - a, c - a, d)), height = signs(det(b - a, c - a, p - a));
  if (eye == 0 && light == 0) return 0;
  if (eye == kUnknown || light == kUnknown || fall != kDown) return kUnknown;
  const int from_eye = abs(eye), from_light = abs(light);
  if (from_eye != from_light && height == kDoubt) return kUnknown;
  if (kZPass == 0) return height == kDown ? -from_light : -from_eye;
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
    change = fan(d, l, push.apex, a, b);
  } else if (face_plane == receiver.plane) {
    change = coplanar_cap(p, d, l, a, b, c);
  } else {
    change = cap(p, d, a, b, c);
  }
  if (change == kUnknown) {
    doubts[slot] = 1;
  } else if (change != 0) {
    atomicAdd(counts[slot], change * face_weight);
  }
}
