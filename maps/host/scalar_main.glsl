// SPDX-License-Identifier: Apache-2.0
// Computes V of each receiver from the maps of one light point; see look_up.glsl.
void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  float v = 1.0;
  if (receiver.n != vec3(0.0)) {
    const LightView view = views[0];
    receiver_plane = receiver.plane;
    receiver_object = receiver.object;
#ifdef FITTED_FACES
    receiver_depth = (dot(table_of_faces.forward, receiver.p) + table_of_faces.offset) /
                     (dot(table_of_faces.divisor, receiver.p) + table_of_faces.divisor_offset);
#endif
    const vec3 d = to_basis(lookup.basis, receiver.p - view.point);
    v = on_emitting_side(d) ? visibility_of(view, d, -to_basis(lookup.basis, receiver.n)) : 0.0;
  }
  results[lookup.first_result + i] = floatBitsToUint(v);
}
