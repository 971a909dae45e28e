// SPDX-License-Identifier: Apache-2.0
// Queries for the light samples in a rectangle or a triangle of the light's plane. Includers define SAMPLE_BANDS first,
// the binding of LightSampleBands' buffer; hide_sample(j) is group_mask_main.glsl's.
#include "maps/backprojection/patches/light_samples.glsl"

uint band_of(float y) {
  precise float from_lower = y - bands.lower;
  precise float band = floor(from_lower * bands.per_unit);
  return uint(clamp(band, 0.0, float(bands.bands - 1)));
}

// One of the sorted samples.
struct SortedSample {
  vec2 at;
  uint index;
};
SortedSample sorted_sample(uint i) {
  const uint k = 2 * bands.samples + bands.bands + 1 + 3 * i;
  return SortedSample(uintBitsToFloat(uvec2(band_words[k], band_words[k + 1])), band_words[k + 2]);
}

// Returns the sorted index of the first sample of a band whose x is not less than `x`.
uint first_sample(uint first, uint last, float x) {
  while (first < last) {
    const uint middle = (first + last) / 2;
    if (sorted_sample(middle).at.x < x) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  return first;
}

void hide_sample(uint j);
bool all_samples_hidden();

// The light's bounding rectangle has 64 x 64 squares; those that contain samples still visible are marked, because most
// areas hidden by texels lie between samples. A row is two words.
const uint kSquares = 64;
const uint kMostRows = 8;  // largest number of rows tested: a taller area counts as containing samples
shared uint square_words[2 * kSquares];

uvec2 square_of(vec2 s) {
  precise vec2 from_lower = s - light.lower;
  precise vec2 at = from_lower * (float(kSquares) / (light.upper - light.lower));
  return uvec2(clamp(at, vec2(0.0), vec2(kSquares - 1)));
}

// Returns the bits of squares first ... last in a word of a row.
uint squares_between(uint first, uint last, uint word) {
  const int from = max(int(first) - 32 * int(word), 0), to = min(int(last) - 32 * int(word), 31);
  return to < from ? 0 : 0xffffffffu >> (31 - (to - from)) << from;
}

bool holds_samples(vec2 lower, vec2 upper) {
  if (any(greaterThan(lower, light.upper)) || any(lessThan(upper, light.lower)) || all_samples_hidden()) return false;
  const uvec2 first = square_of(lower), last = square_of(upper);
  if (last.y - first.y > kMostRows) return true;
  const uvec2 masks = uvec2(squares_between(first.x, last.x, 0), squares_between(first.x, last.x, 1));
  for (uint row = first.y; row <= last.y; ++row) {
    if ((square_words[2 * row] & masks.x) != 0 || (square_words[2 * row + 1] & masks.y) != 0) return true;
  }
  return false;
}

// Clears all squares; after that, the whole workgroup marks samples.
void clear_squares() {
  for (uint word = gl_LocalInvocationIndex; word < 2 * kSquares; word += gl_WorkGroupSize.x) square_words[word] = 0;
}
void mark_sample(uint j) {
  const uvec2 square = square_of(light_sample(j));
  atomicOr(square_words[2 * square.y + square.x / 32], 1u << (square.x & 31));
}

// Edges a to b, b to c, c to a of a triangle in the light's plane, in homogeneous coordinates with w > 0. Edges are
// cross products of their ends, so that a common edge of two triangles has exactly opposite values for a sample: the
// sample is on the inner side in one triangle only, or on the edge. Samples on an edge are inside.
struct LightTriangle {
  vec3 edges[3];
};

vec3 edge_between(vec3 a, vec3 b) {
  precise vec3 edge = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return edge;
}

float side_of(vec3 edge, vec2 s) {
  precise float side = edge.x * s.x + edge.y * s.y + edge.z;
  return side;
}

// Hides the samples between two corners of the light, both included; `in_triangle`: only samples that are also in
// `triangle`.
void hide_between(vec2 lower, vec2 upper, bool in_triangle, LightTriangle triangle) {
  const uint last_band = band_of(upper.y);
  for (uint band = band_of(lower.y); band <= last_band; ++band) {
    const uint words = 2 * bands.samples + band;
    const uint end = band_words[words + 1];
    for (uint i = first_sample(band_words[words], end, lower.x); i < end; ++i) {
      const SortedSample one = sorted_sample(i);
      if (one.at.x > upper.x) break;
      if (one.at.y < lower.y || one.at.y > upper.y) continue;
      if (in_triangle) {
        const vec3 sides =
            vec3(side_of(triangle.edges[0], one.at), side_of(triangle.edges[1], one.at), side_of(triangle.edges[2], one.at));
        if (any(lessThan(sides, vec3(0.0))) && any(greaterThan(sides, vec3(0.0)))) continue;
      }
      hide_sample(one.index);
    }
  }
}

void hide_rectangle(vec2 a, vec2 b) {
  LightTriangle none;
  none.edges[0] = none.edges[1] = none.edges[2] = vec3(0.0);
  if (holds_samples(min(a, b), max(a, b))) hide_between(min(a, b), max(a, b), false, none);
}

// Hides the samples in a triangle with corners as returned by onto_light, w > 0.
void hide_triangle(vec3 a, vec3 b, vec3 c) {
  const vec2 p = a.xy / a.z, q = b.xy / b.z, r = c.xy / c.z;
  // The margin lets the edges decide about a sample at the very corner of the triangle. A quotient is off by 2.5 units
  // in its last place, a relative 1.5e-7, and around 0 no sample is farther off than the light's width: the margin is
  // more than sixty times this error.
  const vec2 margin = 1e-5 * (light.upper - light.lower);
  const vec2 lower = min(min(p, q), r) - margin, upper = max(max(p, q), r) + margin;
  if (!holds_samples(lower, upper)) return;
  LightTriangle triangle;
  triangle.edges[0] = edge_between(a, b);
  triangle.edges[1] = edge_between(b, c);
  triangle.edges[2] = edge_between(c, a);
  hide_between(lower, upper, true, triangle);
}
