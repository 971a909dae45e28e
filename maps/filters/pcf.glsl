#include "maps/filters/pcf.shared.h"
#define OWN_PUSH PcfPush
#include "maps/host/look_up.glsl"

// Percentage-closer filtering (Reeves, Salesin, Cook 1987; Eisemann et al. 2009, equation 4.1) with equal weights: the
// share of the window x window texels around the receiver whose depth test says lit.

#include "maps/host/neighbours.glsl"

float visibility_of(LightView view, vec3 d, vec3 m) {
  const float h = dot(m, d);
  if (h <= 0.0) return 0.0;  // the light's centre is below the receiver's horizon
  const Tap own_tap = fetch(view, 0, lookup.size, d);
#ifdef FITTED_FACES
  vec2 place;
  const uint number = find_face(vec3(d.xy, abs(d.z)), d.z < 0.0 ? 1 : 0, place);
  if (number == table_of_faces.count) return 1.0;
  const vec2 at = place * float(lookup.size);
#else
  const FaceHit hit = face_hit(view, d);
  const vec2 step = (hit.upper - hit.lower) / float(lookup.size);
  const vec2 at = (hit.f.xy / hit.f.z - hit.lower) / step;
#endif
  // As many texels on either side of the receiver as there can be: an odd window is centred on the receiver's texel, an
  // even one on the texel border nearest to it.
  const vec2 first = floor(at - 0.5 * float(own.window) + 0.5) - floor(at);

  uint lit = 0;
  for (uint j = 0; j < own.window; ++j) {
    for (uint i = 0; i < own.window; ++i) {
      const vec2 offset = first + vec2(i, j);
#ifdef FITTED_FACES
      vec3 direction = face_direction(fitted_faces[number], (floor(at) + offset + 0.5) / float(lookup.size));
      direction.z *= own_tap.mirrored;
#else
      const vec3 direction = neighbour(own_tap, step, offset);
#endif
      // A hemicube's window may reach behind the light's plane, where nothing is between light and receiver.
      bool blocked = false;
      if (direction.z * own_tap.mirrored > 0.0) {
        const Tap tap = fetch(view, 0, lookup.size, direction * own_tap.along);
        const float away = max(abs(offset.x), abs(offset.y));
        blocked = texel_blocks(tap, m, h, tap.along, away);
      }
      lit += blocked ? 0 : 1;
    }
  }
  return float(lit) / float(own.window * own.window);
}

#include "maps/host/scalar_main.glsl"
