// SPDX-License-Identifier: Apache-2.0
// Computes one bit for each light point, each from its own maps; see look_up.glsl. One invocation processes a batch of
// up to 32 light points for one receiver. Batches come in the order of light samples; the first batch of a word writes
// the word, later ones add their bits.
void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  const bool receives = receiver.n != vec3(0.0);
  const vec3 m = -to_basis(lookup.basis, receiver.n);
  const uint first_bit = lookup.first_point & 31;

  uint visible = 0;
  for (uint k = 0; k < lookup.point_count; ++k) {
    bool lit = true;
    if (receives) {
      const LightView view = views[lookup.first_point + k];
      const vec3 d = to_basis(lookup.basis, receiver.p - view.point);
      lit = on_emitting_side(d) && sees(view, k * lookup.faces, d, m);
    }
    visible |= lit ? 1u << (first_bit + k) : 0u;
  }
  const uint word = (lookup.first_result + i) * lookup.words_per_pixel + lookup.first_point / 32;
  results[word] = first_bit == 0 ? visible : results[word] | visible;
}
