#include "maps/filters/pcf.shared.h"
#define OWN_PUSH PcfPush
#include "maps/host/look_up.glsl"

// Percentage-closer filtering (Reeves, Salesin, Cook 1987; Eisemann et al. 2009, equation 4.1): the fraction, equally
// weighted or not, of the window x window texels around the receiver whose depth test passes.

#include "maps/host/neighbours.glsl"

// Receiver in texels of its face, and the values common to all of its taps.
struct PcfAsking {
  vec3 m;
  float h;
  Tap own_tap;
  vec2 at, step;
  uint number;  // index of the face, with FITTED_FACES
};

// Returns whether the texel at `offset` texels from the receiver's own does not shade the receiver.
bool is_lit(LightView view, PcfAsking asking, vec2 offset) {
  const Tap own_tap = asking.own_tap;
#ifdef FITTED_FACES
  vec3 direction = face_direction(fitted_faces[asking.number], (floor(asking.at) + offset + 0.5) / float(lookup.size));
  direction.z *= own_tap.mirrored;
#else
  const vec3 direction = neighbour(own_tap, asking.step, offset);
#endif
  // A hemicube's window may extend behind the light's plane, where no occluder can be between light and receiver.
  if (!(direction.z * own_tap.mirrored > 0.0)) return true;
  const Tap tap = fetch(view, 0, lookup.size, direction * own_tap.along);
  return !texel_blocks(tap, asking.m, asking.h, tap.along, max(abs(offset.x), abs(offset.y)));
}

// Returns the weight of a texel at distance `beside`, in texels, from the middle of the window.
float weight_of(vec2 beside) {
  if (own.weights != kGaussian) return 1.0;
  const float deviation = 0.25 * float(own.window);
  return exp(-0.5 * dot(beside, beside) / (deviation * deviation));
}

// Returns the result of taps spread over the disk in the window (Uralsky 2005), rotated by another angle at every
// receiver; the outermost taps first, and with `stages` of 2 no others if these agree.
float spread_taps(LightView view, PcfAsking asking, vec3 d) {
  uint bits = floatBitsToUint(d.x) * 0x9e3779b1u ^ floatBitsToUint(d.y) * 0x85ebca77u ^ floatBitsToUint(d.z) * 0xc2b2ae3du;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  bits ^= bits >> 12;
  const float turn = float(bits >> 8) * (6.283185307 / 16777216.0);
  const uint first_stage = max(own.taps / 4, min(own.taps, 4));
  float lit = 0.0, total = 0.0;
  for (uint k = 0; k < own.taps; ++k) {
    const float place = float(own.taps - k) - 0.5, angle = turn + 2.399963230 * place;
    const vec2 beside = 0.5 * float(own.window) * sqrt(place / float(own.taps)) * vec2(cos(angle), sin(angle));
    const float weight = weight_of(beside);
    total += weight;
    if (is_lit(view, asking, floor(asking.at + beside) - floor(asking.at))) lit += weight;
    if (own.stages == 2 && k + 1 == first_stage && (lit == 0.0 || lit == total)) break;
  }
  return lit / total;
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  PcfAsking asking;
  asking.m = m;
  asking.h = dot(m, d);
  if (asking.h <= 0.0) return 0.0;  // the light's centre is below the receiver's horizon
  asking.own_tap = fetch(view, 0, lookup.size, d);
#ifdef FITTED_FACES
  vec2 place;
  asking.number = find_face(vec3(d.xy, abs(d.z)), d.z < 0.0 ? 1 : 0, place);
  if (asking.number == table_of_faces.count) return 1.0;
  asking.at = place * float(lookup.size);
#else
  const FaceHit hit = face_hit(view, d);
  asking.step = (hit.upper - hit.lower) / float(lookup.size);
  asking.at = (hit.f.xy / hit.f.z - hit.lower) / asking.step;
#endif
  if (own.taps != 0) return spread_taps(view, asking, d);

  const float width = float(own.window);
  const vec2 texel = floor(asking.at);
  // A window has as many texels on either side of the receiver as possible: an odd window is centred on the receiver's
  // texel, an even one on the texel border nearest to the receiver. Bilinear: the window is centred on the receiver,
  // and texels at its border are weighted by their part inside; with one texel these are the four of a bilinear test.
  const bool bilinear = own.weights == kBilinear;
  const vec2 first = floor(asking.at - 0.5 * width + (bilinear ? 0.0 : 0.5)) - texel;
  const uint count = own.window + (bilinear ? 1 : 0);
  float lit = 0.0, total = 0.0;  // integers if all weights are equal
  for (uint j = 0; j < count; ++j) {
    for (uint i = 0; i < count; ++i) {
      const vec2 offset = first + vec2(i, j);
      float weight = weight_of(vec2(i, j) - 0.5 * (width - 1.0));
      if (bilinear) {
        const vec2 lower = texel + offset;
        const vec2 part = min(lower + 1.0, asking.at + 0.5 * width) - max(lower, asking.at - 0.5 * width);
        weight = max(part.x, 0.0) * max(part.y, 0.0);
      }
      total += weight;
      if (is_lit(view, asking, offset)) lit += weight;
    }
  }
  return lit / total;
}

#include "maps/host/scalar_main.glsl"
