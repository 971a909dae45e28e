// SPDX-License-Identifier: Apache-2.0
// Main function of the second pass of edge scatter: computes the visibility bits of a few view samples from the lists
// of edges and triangles. Included by scatter_edges.comp and scatter_points.comp. Bounds: docs/edge-scatter.md.

void main() {
  make_frame();
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint group_height = kLanes / kGroupWidth, groups_across = kBlock / kGroupWidth, groups_per_block = kBlock * kBlock / kLanes;
  const uint block = group / (groups_per_block * band_count()), band = group / groups_per_block % band_count(), member = group % groups_per_block;
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
  begin_band(band);
  open_pixel = false;
  side_in_doubt = false;
  out_of_range = 0;
  const uint all_samples = samples_of_band();

  bool on = inside && at.carrier != kNone;
  const bool receives = on;
  // Condition (2) of docs/definitions.md: p is strictly on an emitting side of the light's plane. (bound level)
  const float error_level = level_error(at.p);
  if (on && abs(at.height) <= error_level) {
    open_pixel = push.side > 0.0;                         // both sides have a dispatch, but only one asks the host
    on = false;
  }
  const bool other_side = receives && at.height < -error_level;
  if (other_side) on = false;
  // Condition (1) of docs/definitions.md: the light sample is strictly above the carrier's plane. The part of the light
  // above that plane is bounded by one line. (bound horizon)
  const vec3 towards = -from_center;
  const vec3 above = vec3(dot(at.normal, push.u), dot(at.normal, push.v), dot(at.normal, towards));
  const float error_above = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(at.p)) + push.deviation;
  const float span = abs(above.x) + abs(above.y);
  const bool below = on && above.z + span < -error_above, straddles = on && !below && above.z - span <= error_above;
  if (below) on = false;

  if (on && sees_flat(away, at.height)) open_pixel = true;
  // `any_touched` refers to the whole light, not to this band: if a pixel's mask is read, each of its bands must have
  // written its words.
  const bool any_touched = subgroupAny(on && (push.touched_low | push.touched_high) != 0);

  uint visible = receives ? 0 : all_samples;
  const uint cluster = on ? heads[2 * kClusters * block_count() + pixel] : kNone;
  uint depth = 0;
  cut_off = false;
  const bool any_edges = subgroupAny(on && heads[2 * (block * kClusters + (on ? cluster : 0))] != kNone);
  const bool by_rows = any_edges || any_touched || subgroupAny(straddles);
  const uint cleared = by_rows ? kHistogramWords : 0;
  for (uint word = 0; word < cleared; ++word) histogram[word * kLanes + gl_SubgroupInvocationID] = 0;
  if (on && any_touched) open_touched();
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
  if (receives) ask(pixel, on && by_rows);
  if (open_pixel) visible = 0;                            // the host counts
  const bool mine = inside && !(other_side && push.keeps_rest != 0) && (receives || push.side > 0.0);
  if (mine && visible != 0) atomicAdd(counts[push.first_pixel + pixel], visible);
}
