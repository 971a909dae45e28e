// SPDX-License-Identifier: Apache-2.0
// Kernels of a receiver processed by a workgroup of 64 invocations; see look_up.glsl. The shader defines
//   Kernel kernel_of(MapFace face)                              the texels of a face to process
//   bool nothing_hides(MapFace face, ivec2 first, ivec2 last)   true if certainly none of these texels hides any light
// and the functions required by its main: group_scalar_main.glsl, group_mask_main.glsl, which process kernels by
// group_tiles.glsl. All of them read `asked`.
#include "maps/host/kernel.glsl"

// Receiver of this workgroup in (x, y, |z|): e from the light's centre, m its normal away from the light.
struct Asked {
  LightView view;
  uint number;  // index of the side of the light's plane
  SideView side;
  vec3 e, m;
};
Asked asked;
int stride = 1;           // kernel_of may choose every stride-th texel, each for its block
bool all_hidden = false;  // set by kernel_of if nothing of the light is seen
int tile_shift = 0;       // kernel_of may begin tiles this many texels before a multiple of 8

// Sets `asked`; returns false if no light reaches the receiver's side of the light's plane.
bool ask(Receiver receiver) {
  asked.view = views[0];
  const vec3 d = to_basis(lookup.basis, receiver.p - asked.view.point);
  const vec3 m = -to_basis(lookup.basis, receiver.n);
  asked.number = d.z < 0.0 ? 1 : 0;
  asked.side = asked.view.side[asked.number];
  asked.e = vec3(d.xy, abs(d.z));
  asked.m = d.z < 0.0 ? vec3(m.xy, -m.z) : m;
  return on_emitting_side(d);
}

// Returns a texel of layer `layer`, prepared for this receiver: along the face's axis the tap extends to the receiver's
// height.
Tap ask_texel(MapFace face, uint layer, uvec2 cell) {
  face.map += layer * lookup.faces;
  Tap tap = tap_of(asked.view, lookup.size, face, cell);
  tap.along = asked.e.z / tap.direction.z;
  return tap;
}

// Detects loops ended by the driver. Drivers for processors end all loops of an invocation after 65,535 iterations in
// total. Then the loop below also ends immediately: the host runs this workgroup again, with fewer rows of the map at a
// time. (`layers` is at least 1, which is unknown to the compiler.)
void check_that_loops_ended() {
  uint turns = 0;
  while (turns < lookup.layers + 1) ++turns;
  if (turns == lookup.layers + 1) return;
  const uint end = results.length() - kCutLoopWords;
  results[results[end + 2] + lookup.first_result + this_group()] = 1;
  results[end] = 1;
}

// Return whether this is the first pass, and whether this workgroup must run: in the first pass all do, then those
// whose loops were ended.
bool is_first_pass() { return results[results.length() - kCutLoopWords + 1] == 0; }
bool is_asked() {
  const uint asked_from = results[results.length() - kCutLoopWords + 1];
  return asked_from == 0 || results[asked_from + lookup.first_result + this_group()] != 0;
}
