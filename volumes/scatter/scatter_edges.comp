#version 460
#extension GL_GOOGLE_include_directive : require
#include "engines/device/mask.shared.h"
#include "volumes/edges/edge_scatter.glsl"

// Second pass of edge scatter, a workgroup a few neighbouring view samples (one a lane) and a band of light rows: how many
// triangles are between p and each light sample. D at the light's lower left corner is counted triangle by triangle. From
// there it changes by ∓k_e(p) at each projected edge: up the light's left side, then along each row. Edges are scattered
// into a histogram [column][row] of such changes, in bytes; one running sum makes depths of them.
// Derivation, bounds and what becomes of light rows that rounding leaves open: docs/edge-scatter.md.

layout(constant_id = 2) const uint kGroupWidth = 4;       // pixels; its height is lanes / width
layout(constant_id = 3) const uint kColumns = 16;         // of light samples
layout(constant_id = 4) const uint kWordsPerColumn = 4;   // four light rows a word: rows of a band / 4
layout(constant_id = 5) const uint kHistogramWords = 64;  // a lane: columns · words a column

// An edge record (EdgeTexels), a texel buffer each: (a, plane 1), (b, plane 2), (n 1), (anchor 1), (n 2), (anchor 2).
layout(binding = 3) uniform usamplerBuffer record_a;
layout(binding = 4) uniform usamplerBuffer record_b;
layout(binding = 5) uniform usamplerBuffer record_n1;
layout(binding = 6) uniform usamplerBuffer record_anchor1;
layout(binding = 7) uniform usamplerBuffer record_n2;
layout(binding = 8) uniform usamplerBuffer record_anchor2;
// A triangle: (a, triangle), (b, plane), (c, light that it is the body of).
layout(binding = 9) uniform usamplerBuffer corner_a;
layout(binding = 10) uniform usamplerBuffer corner_b;
layout(binding = 11) uniform usamplerBuffer corner_c;
layout(scalar, binding = 12) buffer Masks { uint masks[]; };    // visible: 8 columns × 4 rows a word
layout(scalar, binding = 13) buffer Counts { uint counts[]; };  // visible light samples of a pixel
layout(scalar, binding = 14) buffer Questions {
  QuestionHead asked;
  RowQuestion questions[];
};

// Some devices run a loop's body once even for no turn at all, and once more than a `for` asks: loops that count are
// written do … while, their bodies harmless where there is nothing to do.

shared uint histogram[kHistogramWords * kLanes];

// This lane's view sample.
ViewSample at;
vec3 from_center;
float away;                                               // |from_center|
float lift_per_length;                                    // lift_of
int first_row, last_row;                                  // of the band
uint left_changes[kWordsPerColumn];                       // where edges cross the light's left side, a byte a row
uvec2 open_rows;                                          // light rows of the band for the host
uvec2 open_samples;                                       // and two more light samples, or kNone
bool open_pixel;                                          // all of them
bool side_in_doubt;                                       // of some edge's triangle: within rounding of p
bool cut_off;                                             // a loop did not run to its end
uint out_of_range;                                        // bytes of changes on the light's left side: open all rows

#include "volumes/scatter/scatter_one.glsl"
#include "volumes/scatter/scatter_group.glsl"
#include "volumes/scatter/scatter_corner.glsl"
#include "volumes/scatter/scatter_sum.glsl"

// Of the first `count` of 64 rows.
uvec2 first_rows(int count) {
  return uvec2(count >= 32 ? 0xffffffffu : (1u << count) - 1, count >= 64 ? 0xffffffffu : count > 32 ? (1u << (count - 32)) - 1 : 0);
}

// Those of the band in which something touches light samples.
uvec2 touched_rows() {
  uvec2 rows = uvec2(push.touched_low, push.touched_high);
  if (push.rows <= 64 && first_row >= 32) rows = uvec2(rows.y, 0);
  const int shift = first_row % 32;
  if (push.rows <= 64 && shift != 0) rows = uvec2(rows.x >> shift | rows.y << (32 - shift), rows.y >> shift);
  return rows & first_rows(last_row + 1 - first_row);
}

void main() {
  make_frame();
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint group_height = kLanes / kGroupWidth, groups_across = kBlock / kGroupWidth, groups_per_block = kBlock * kBlock / kLanes;
  const uint band_rows = 4 * kWordsPerColumn, bands = (push.rows + band_rows - 1) / band_rows;
  const uint block = group / (groups_per_block * bands), band = group / groups_per_block % bands, member = group % groups_per_block;
  const uint blocks_across = (push.width + kBlock - 1) / kBlock;
  const uvec2 corner = uvec2(block % blocks_across, block / blocks_across) * kBlock +
                       uvec2(member % groups_across * kGroupWidth, member / groups_across * group_height);
  const uvec2 place = corner + uvec2(gl_SubgroupInvocationID % kGroupWidth, gl_SubgroupInvocationID / kGroupWidth);
  const bool inside = place.x < push.width && place.y < push.row_count;
  const uint pixel = inside ? place.y * push.width + place.x : 0;
  at = fetch_view_sample(pixel);
  from_center = at.p - push.center;
  away = length(from_center);
  lift_per_length = lift_of(at, 2.0 * half_cells + 2.0);
  first_row = int(band * band_rows);
  last_row = min(first_row + int(band_rows), int(push.rows)) - 1;
  for (uint word = 0; word < kWordsPerColumn; ++word) left_changes[word] = 0;
  open_rows = uvec2(0);
  open_samples = uvec2(kNone);
  open_pixel = false;
  side_in_doubt = false;
  out_of_range = 0;
  const uint all_samples = uint(last_row - first_row + 1) * kColumns;

  bool on = inside && at.carrier != kNone;
  const bool receives = on;
  // (2) p strictly on an emitting side of the light's plane. (bound level)
  const float error_level = level_error(at.p);
  if (on && abs(at.height) <= error_level) {
    open_pixel = push.side > 0.0;                         // one of two dispatches asks
    on = false;
  }
  const bool other_side = receives && at.height < -error_level;
  if (other_side) on = false;
  // (1) The light sample strictly above the carrier's plane: one half-plane of the light. (bound horizon)
  const vec3 towards = -from_center;
  const vec3 above = vec3(dot(at.normal, push.u), dot(at.normal, push.v), dot(at.normal, towards));
  const float error_above = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(at.p)) + push.deviation;
  const float span = abs(above.x) + abs(above.y);
  const bool below = on && above.z + span < -error_above, straddles = on && !below && above.z - span <= error_above;
  if (below) on = false;

  if (on) open_rows = touched_rows();
  if (on && sees_flat(away, at.height)) open_pixel = true;
  // Of the light, not of this band: where a pixel's mask is read, each of its bands has to have written its words.
  const bool any_touched = subgroupAny(on && (push.touched_low | push.touched_high) != 0);

  uint visible = receives ? 0 : all_samples;
  const uint cluster = on ? heads[2 * kClusters * block_count() + pixel] : kNone;
  uint depth = 0;
  cut_off = false;
  const bool any_edges = subgroupAny(on && heads[2 * (block * kClusters + (on ? cluster : 0))] != kNone);
  const bool by_rows = any_edges || any_touched || subgroupAny(straddles);
  const uint cleared = by_rows ? kHistogramWords : 0;
  for (uint word = 0; word < cleared; ++word) histogram[word * kLanes + gl_SubgroupInvocationID] = 0;
  for (uint i = 0; i < kClusters; ++i) {
    const bool here = on && cluster == i;
    if (!subgroupAny(here)) continue;
    const uint edges = heads[2 * (block * kClusters + i)], triangles = heads[2 * (block * kClusters + i) + 1];
    if (triangles != kNone) {
      const uint met = count_to_corner(triangles, here, edges == kNone);
      if (here) depth = met;
    }
    if (edges != kNone) scatter_list(edges, here);
    if (triangles != kNone && subgroupAny(side_in_doubt)) open_where_on(triangles, here);
  }
  if (by_rows) {
    const uint counted = count_visible(pixel, depth, on);
    if (on) visible = counted;
    if (subgroupAny(straddles)) {
      if (straddles) visible = cut_at_horizon(pixel, above, error_above);
    }
  } else if (on) {
    visible = depth == 0 ? all_samples : 0;
  }
  if ((cut_off || out_of_range != 0) && on) open_pixel = true;
  if (open_pixel) visible = 0;                            // the host counts
  const bool mine = inside && !(other_side && push.keeps_rest != 0) && (receives || push.side > 0.0);
  if (mine && visible != 0) atomicAdd(counts[push.first_pixel + pixel], visible);
  if (!on) open_rows = uvec2(0);
  if (receives && (open_pixel || (open_rows.x | open_rows.y) != 0 || open_samples.x != kNone)) {
    const uint question = atomicAdd(asked.count, 1);
    const int band = last_row + 1 - first_row;
    if (open_pixel) open_rows = first_rows(band);
    if (question < push.question_capacity) questions[question] = RowQuestion((push.first_pixel + pixel) | (open_pixel ? kWholePixel : 0), uint(first_row), open_rows.x, open_rows.y, open_samples.x, open_samples.y);
  }
}
