// SPDX-License-Identifier: Apache-2.0
// Sorting pass of group_scalar_main.glsl (group_list.glsl): computes V of the receivers none of whose texels can hide
// light, or all of whose texels do, and lists the others.
bool is_left = false;

void look_at_kernel(MapFace face, Kernel kernel) {
  if (is_left || is_empty(kernel)) return;
  is_left = !nothing_hides(face, kernel.first, kernel.last + stride - 1);
}

#include "maps/host/group_faces.glsl"

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  float v = 1.0;
  if (receiver.n != vec3(0.0)) {
    v = 0.0;
    if (ask(receiver)) {
      look_at_faces();
      v = visible_above(all_hidden ? 0.0 : 1.0, share_above());
    }
  }
  if (is_left) {
    list_group();
  } else {
    results[lookup.first_result + i] = floatBitsToUint(v);
  }
}
