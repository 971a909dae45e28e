// SPDX-License-Identifier: Apache-2.0
#include "maps/backprojection/contours/contour.shared.h"
#include "maps/backprojection/level_maps.shared.h"
#define GROUP_A_PACKET
#define LISTED_GROUPS
#define OWN_PUSH ContourPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT 5
#include "maps/backprojection/contours/radial.glsl"
#define PYRAMID_BINDING 6
#include "maps/products/depth_pyramid.glsl"
#include "maps/backprojection/thresholds.glsl"

// Computes V from occluder contours (Guennebaud, Barthe and Paulin 2007), found below nodes of a pyramid and for
// packets of pixels (Yang et al. 2009). A workgroup, one subgroup wide, processes a packet of w x h pixels, or a single
// pixel. State of the packet is in this file; outline.glsl has contours, packet_kernel.glsl the cells to search and the
// grouping of pixels, and outline_walk.glsl the search.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };  // caster on each side of the light's plane
layout(scalar, binding = 7) readonly buffer Tree {  // the pyramid used by the search: that of `Pyramid`, or another one
  PyramidHeader header;
  vec2 nodes[];
} tree;
layout(scalar, binding = 8) buffer Work { uint work[]; };

layout(constant_id = 1) const uint kLevels = kFinestLevel;  // kFinestLevel ...: levels of the map that are used
layout(constant_id = 2) const bool kSearch = true;          // true: a pyramid bounds the cells of a kernel
#define LEVEL_MAPS 9
#include "maps/backprojection/levels.glsl"

#ifdef SORTS_OUT
#define OF_PACKET  // each invocation processes a packet, one pixel at a time
const uint kPixels = 1;
#else
#define OF_PACKET shared
const uint kPixels = kMostPacketPixels;
shared int pixel_edges[kPixels];   // the sum in progress
shared int pixel_levels[kPixels];  // inside - sum, over the levels processed so far
#endif
OF_PACKET vec3 pixel_e[kPixels], pixel_m[kPixels];
OF_PACKET uint pixel_state[kPixels];
OF_PACKET int pixel_sum[kPixels];       // inside - sum, in units of 1 / kContourWhole
OF_PACKET float pixel_wanted[kPixels];  // the level requested by the pixel's kernel
OF_PACKET uint pixel_inside[kPixels];   // 1: the light's centre is seen within a contour
OF_PACKET ivec4 pixel_cells[kPixels];   // first and last cells of the pixel's kernel on the current face
OF_PACKET ivec2 pixel_own[kPixels];     // the light's centre is seen between the centres of this texel and the next ones
OF_PACKET vec2 pixel_at[kPixels];       // offset from this texel's centre, in texels
const uint kLit = 2, kBehind = 3;             // states; 0 and 1: a receiver on this side of the light's plane

#ifndef SORTS_OUT
// ---- pixels processed together: all pixels of a packet that have cells to search, or one of these pixels ----
shared uint members[kMostPacketPixels];
shared uint member_count, together;
shared Bounds group;
shared ivec4 group_cells;

shared uint stack[gl_WorkGroupSize.x * 48];
shared uint stack_count, diverged;
shared uint work_done[kWorkCounts];
WorkNumbers done;  // work of this invocation
#endif

LightView view;
uint side_number;
MapFace map_face;  // the current face
MapFace face;      // the current face with texels of the current level
uint face_number;
float face_turn;  // -1 where a left turn in the face is a right turn on the light

void begin_level(uint l) {
  look_at_level(l);
  face = at_level(map_face);
}

#include "maps/backprojection/contours/outline.glsl"
#include "maps/backprojection/contours/packet_kernel.glsl"
#ifndef SORTS_OUT
#include "maps/backprojection/contours/outline_walk.glsl"
#endif

uint group_count() {
  const uint rows = lookup.receiver_count / lookup.width;
  return (lookup.width + own.packet_width - 1) / own.packet_width * ((rows + own.packet_height - 1) / own.packet_height);
}

// Returns the receiver of a pixel of this packet; false beyond the picture.
bool receiver_of(uint pixel, out uint receiver) {
  const uint group_index = this_group();
  const uint across = (lookup.width + own.packet_width - 1) / own.packet_width;
  const uint x = group_index % across * own.packet_width + pixel % own.packet_width;
  const uint y = group_index / across * own.packet_height + pixel / own.packet_width;
  receiver = y * lookup.width + x;
  return x < lookup.width && receiver < lookup.receiver_count;
}

// Loads pixel `of_packet` of this packet; `pixel`: the index of its state.
void load_pixel(uint pixel, uint of_packet) {
  pixel_state[pixel] = kLit;
  pixel_sum[pixel] = 0;
  uint number;
  if (!receiver_of(of_packet, number)) return;
  const Receiver receiver = receivers[lookup.first_receiver + number];
  if (receiver.n == vec3(0.0)) return;
  const vec3 d = to_basis(lookup.basis, receiver.p - view.point), m = -to_basis(lookup.basis, receiver.n);
  pixel_e[pixel] = vec3(d.xy, abs(d.z));
  pixel_m[pixel] = d.z < 0.0 ? vec3(m.xy, -m.z) : m;
  pixel_state[pixel] = !on_emitting_side(d) ? kBehind : d.z < 0.0 ? 1 : 0;
  if (lookup.first_row > 0) pixel_sum[pixel] = int(results[lookup.first_result + number]);
}

void store_pixel(uint pixel, uint of_packet) {
  uint number;
  if (!receiver_of(of_packet, number)) return;
  const uint result = lookup.first_result + number;
  if (lookup.last_row + 1 < lookup.size) {
    results[result] = uint(pixel_sum[pixel]);
    return;
  }
  float v = pixel_state[pixel] == kBehind ? 0.0 : 1.0;
  if (pixel_state[pixel] < kLit) {
    const float hidden = float(clamp(pixel_sum[pixel], 0, kContourWhole)) / float(kContourWhole);
    v = visible_above(1.0 - hidden, light_above_horizon(pixel_e[pixel], pixel_m[pixel]));
  }
  results[result] = floatBitsToUint(v);
}

// Adds to one of the 64-bit counts of all look-ups so far.
void add_work(uint kind, uint amount) {
  if (amount != 0 && atomicAdd(work[2 * kind], amount) + amount < amount) atomicAdd(work[2 * kind + 1], 1);
}

void begin_face() {
  map_face = face_of(view.side[side_number], 0, lookup.size, face_number);
  begin_level(0);
}

#ifdef SORTS_OUT
void main() {
  if (this_group() >= group_count()) return;
  view = views[0];
  bool is_left = false;
  uint looked_at = 0;
  const uint pixels = own.packet_width * own.packet_height;
  for (uint pixel = 0; pixel < pixels; ++pixel, ++looked_at) {
    load_pixel(0, pixel);
    for (side_number = 0; side_number < 1 + lookup.two_sided; ++side_number) {
      if (pixel_state[0] != side_number) continue;
      for (face_number = 0; face_number < view.side[side_number].face_count; ++face_number) {
        begin_face();
        find_kernel(0);
        is_left = is_left || !no_cells(pixel_cells[0]);
      }
    }
    begin_level(0);
    store_pixel(0, pixel);
  }
  // If a driver ended the loop early, the packet is listed, too: its workgroup then processes all of it.
  if (is_left || looked_at != pixels) {
    list_group();
  } else {
    add_work(kTrivialPackets, 1);
  }
}
#else
void count_work(uint kind, uint amount) { atomicAdd(work_done[kind], amount); }

void main() {
  const uint pixels = own.packet_width * own.packet_height;
  if (this_group() >= group_count() || !is_asked()) return;
  view = views[0];
  done = WorkNumbers(0, 0, 0, 0, 0, 0, 0, 0);
  if (gl_LocalInvocationIndex == 0) stack_count = diverged = 0;
  for (uint k = gl_LocalInvocationIndex; k < kWorkCounts; k += gl_WorkGroupSize.x) work_done[k] = 0;
  for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) load_pixel(i, i);
  barrier();

  uint looked_for = 0;
  for (side_number = 0; side_number < 1 + lookup.two_sided; ++side_number) {
    for (face_number = 0; face_number < view.side[side_number].face_count; ++face_number) {
      begin_face();
      face_turn = face.axis == 2 ? 1.0 : face.axis == 0 ? face.sign : -face.sign;
      for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) {
        if (pixel_state[i] != side_number) continue;
        find_kernel(i);
        begin_level(0);
      }
      barrier();
      if (gl_LocalInvocationIndex == 0) choose_members(pixels);
      barrier();
      looked_for += member_count;
      look_for_edges();
    }
  }
  if (gl_LocalInvocationIndex == 0 && looked_for == 0) ++done.trivial;

  for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) store_pixel(i, i);
  count_work(0, done.nodes);
  count_work(1, done.cells);
  count_work(2, done.edges);
  if (is_first_pass()) {  // counts packets once, independent of the number of passes
    count_work(3, done.shared_packets);
    count_work(4, done.parted);
    count_work(5, done.diverged);
    count_work(kTrivialPackets, done.trivial);
    count_work(7, done.kernel_cells);
  }
  barrier();
  for (uint k = gl_LocalInvocationIndex; k < kWorkCounts; k += gl_WorkGroupSize.x) add_work(k, work_done[k]);
  check_that_loops_ended();
}
#endif
