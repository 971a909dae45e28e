// SPDX-License-Identifier: Apache-2.0
#include "maps/host/look_up.glsl"

// Computes V by forward mapping (Zhang 1998): every texel of the light's picture lights the surface it hits, as a splat
// over this surface. A view sample sums the splats that reach it. Splats are B-splines, so that those of a whole
// surface add up to 1.

layout(constant_id = 0) const uint kDegree = 1;  // degree of a splat along each axis: 0, one texel wide; 1, two; 2,
                                                 // three

// Positions in a texel are counted in 64ths, so that weights are integers with the same sum everywhere.
const int kParts = 64;

// Returns the weights along an axis of the texels before, at and behind the own texel of a position, which is `at`
// 64ths of a texel beyond this texel's centre.
ivec3 weights(int at) {
  if (kDegree == 0) return ivec3(0, 1, 0);
  if (kDegree == 1) return ivec3(max(-at, 0), kParts - abs(at), max(at, 0));
  const int kMiddle = kParts / 2;
  return ivec3((kMiddle - at) * (kMiddle - at), 6 * kMiddle * kMiddle - 2 * at * at, (kMiddle + at) * (kMiddle + at));
}
int whole() { return kDegree == 0 ? 1 : kDegree == 1 ? kParts : 2 * kParts * kParts; }

// Returns whether the texel's light hits the receiver's surface, not a surface in front of or behind it. Objects that
// cast no shadow are not in the map: light hits them even if it continues.
bool lands(Tap tap, vec3 d, vec3 m, uint beside) {
  const bool is_drawn = receiver_plane != 0xffffffffu;
  PlaneDepth plane = PlaneDepth(tap.along, lookup.bias * tap.texel * tap.along);
  if (lookup.own_depth == 0) {
    const float limit = tap.along * (1.0 + float(1 + 2 * beside) * kSteepest * tap.texel);
    plane = plane_depth(tap, m, dot(m, d), limit, lookup.bias);
  }
  return !is_before(tap, plane.depth, plane.forgiven) && (!is_drawn || tap.depth <= plane.depth + plane.forgiven);
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
#ifdef FITTED_FACES
  const vec3 e = vec3(d.xy, abs(d.z));
  vec2 place;
  const uint number = find_face(e, d.z < 0.0 ? 1 : 0, place);
  if (number == table_of_faces.count) return 1.0;
  const vec2 at = place * float(lookup.size);
#else
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  if (side.face_count == 0) return 1.0;
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(side, 0, lookup.size, hit.face);
  const vec2 at = (hit.f.xy / hit.f.z - face.lower) / face.texel;
#endif
  const ivec2 last = ivec2(lookup.size) - 1, own = clamp(ivec2(floor(at)), ivec2(0), last);
  const ivec2 part = clamp(ivec2(floor((at - vec2(own) - 0.5) * float(kParts) + 0.5)), -kParts / 2, kParts / 2);
  const ivec3 across = weights(part.x), upward = weights(part.y);
  int sum = 0;
  for (int k = 0; k < 9; ++k) {
    const ivec2 away = ivec2(k % 3, k / 3) - 1;
    const int weight = across[away.x + 1] * upward[away.y + 1];
    if (weight == 0) continue;
    // At a face's border, a border texel is used for texels outside the face.
    const uvec2 cell = uvec2(clamp(own + away, ivec2(0), last));
#ifdef FITTED_FACES
    Tap tap = tap_in_face(view, 0, lookup.size, number, cell, e);
#else
    Tap tap = tap_of(view, lookup.size, face, cell);
    tap.along = hit.f.z;
#endif
    tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
    tap.direction.z *= tap.mirrored;
    if (lands(tap, d, m, away == ivec2(0) ? 0 : 1)) sum += weight;
  }
  return float(sum) / (float(whole()) * float(whole()));
}

#include "maps/host/scalar_main.glsl"
