// The patch as its bounding sphere, the light as the disk of its area that faces the receiver (Bavoil and Silva 2006): the
// share of the light's cap of directions that the sphere's cap covers. Included after group_kernel.glsl, light_table.glsl.

// The area that two circles of a plane share.
float lens(float r, float s, float apart) {
  const float small = min(r, s), large = max(r, s);
  if (apart >= small + large) return 0.0;
  if (apart <= large - small) return 3.14159265358979 * small * small;
  const float x = (apart * apart + large * large - small * small) / (2.0 * apart);  // the chord, from the larger's centre
  const float y = apart - x;
  const float half_chord = sqrt(max(0.0, large * large - x * x));
  return large * large * acos(clamp(x / large, -1.0, 1.0)) + small * small * acos(clamp(y / small, -1.0, 1.0)) -
         apart * half_chord;
}

uint sphere_hides(MapFace face, Tap tap) {
  const vec3 to_light = -asked.e, to_sphere = tap.depth * tap.direction - asked.e;
  const float radius = 0.5 * length(face.texel) * tap.depth;
  const float distance_to_light = length(to_light), distance_to_sphere = length(to_sphere);
  // A sphere around the receiver covers the half of all directions.
  const float sphere_angle = radius < distance_to_sphere ? asin(radius / distance_to_sphere) : 1.57079632679490;
  const float light_angle = atan(sqrt(light.area / 3.14159265358979), distance_to_light);
  const float between = 2.0 * atan(length(to_light * distance_to_sphere - to_sphere * distance_to_light),
                                   length(to_light * distance_to_sphere + to_sphere * distance_to_light));
  // Chords stand for angles: the disk of a cap's chord has the cap's area, and where one cap lies in the other, or beside
  // it, the shared area is exact.
  float covered;
  const float r = 2.0 * sin(0.5 * light_angle), s = 2.0 * sin(0.5 * sphere_angle);
  if (between >= light_angle + sphere_angle) return 0;
  if (between <= abs(light_angle - sphere_angle)) {
    covered = 3.14159265358979 * min(r, s) * min(r, s);
  } else {
    covered = lens(r, s, 2.0 * sin(0.5 * between));
  }
  return uint(clamp(covered / (3.14159265358979 * r * r), 0.0, 1.0) * float(kWholeLight) + 0.5);
}
