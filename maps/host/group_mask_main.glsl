// SPDX-License-Identifier: Apache-2.0
// Computes a mask of each receiver, one bit for each light sample, from maps of the light's centre, whose texels are
// processed by a workgroup; see group_kernel.glsl. The shader also defines
//   void hide(MapFace face, uvec2 cell)                       calls hide_sample(j) for each sample hidden by a texel
//   bool is_mine(uint j)                                      whether the current kernel may hide this sample
//   Kernel next_kernel(MapFace face, uint turn)               a kernel after the first, on turns 1, 2 …; empty: none
//   uint light_sample_count(), vec2 light_sample(uint j)      the samples, in the light's basis
//   void clear_squares(), void mark_sample(uint j)            mark samples to be tested: called by all invocations
//   uint occluders_of_a_texel()                               number of occluders tested by hide()
//   void add_work(uint occluders)                             called once for each receiver with the number tested
// With LOOK_AT_KERNEL the shader defines, in place of hide, clear_squares and mark_sample and after including this
// file,
//   void look_at_kernel(MapFace face, Kernel kernel)          hides the samples hidden by a kernel, in all invocations
const uint kMaskWords = 128;  // 4096 light samples
shared uint hidden_bits[kMaskWords];
shared uint hidden_count;
shared uint looked_at_count;

void hide_sample(uint j) {
  if (!is_mine(j)) return;
  const uint bit = 1u << (j & 31);
  if ((hidden_bits[j / 32] & bit) == 0 && (atomicOr(hidden_bits[j / 32], bit) & bit) == 0) atomicAdd(hidden_count, 1);
}

uint looked_at = 0;  // number of texels processed by this invocation

bool all_samples_hidden() { return hidden_count >= light_sample_count(); }

#ifdef LOOK_AT_KERNEL
void look_at_kernel(MapFace face, Kernel kernel);
#else
void before_tiles() {
  clear_squares();
  barrier();
  for (uint j = gl_LocalInvocationIndex; j < light_sample_count(); j += gl_WorkGroupSize.x) {
    if (is_mine(j) && (hidden_bits[j / 32] & 1u << (j & 31)) == 0) mark_sample(j);
  }
}

// Counts the texel even if all samples are hidden by now: invocations notice this at different times, and the count
// must not depend on that.
void look_at(MapFace face, uvec2 cell) {
  ++looked_at;
  if (!all_samples_hidden()) hide(face, cell);
}

#include "maps/host/group_tiles.glsl"
#endif
#include "maps/host/group_faces.glsl"

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count || !is_asked()) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  const uint lane = gl_LocalInvocationIndex;
  for (uint word = lane; word < kMaskWords; word += gl_WorkGroupSize.x) hidden_bits[word] = 0;
  if (lane == 0) hidden_count = looked_at_count = 0;
  barrier();

  const bool receives = receiver.n != vec3(0.0);
  const bool reached = receives && ask(receiver);
  if (reached) {
    look_at_faces();
  }
  atomicAdd(looked_at_count, looked_at);
  barrier();
  if (lane == 0 && looked_at_count > 0) add_work(looked_at_count * occluders_of_a_texel());

  const uint samples = light_sample_count();
  for (uint word = lane; word < lookup.words_per_pixel; word += gl_WorkGroupSize.x) {
    const uint used = min(samples - 32 * word, 32u);
    uint visible = used == 32 ? 0xffffffffu : (1u << used) - 1;
    if (receives) {
      visible = reached && !all_hidden ? visible & ~hidden_bits[word] : 0;
      // Light samples that are not strictly above the receiver's horizon are not visible.
      for (uint bit = 0; bit < used; ++bit) {
        const vec3 s = vec3(light_sample(32 * word + bit), 0.0);
        if (!(dot(asked.m, asked.e - s) > 0.0)) visible &= ~(1u << bit);
      }
    }
    const uint result = (lookup.first_result + i) * lookup.words_per_pixel + word;
    results[result] = lookup.first_row == 0 ? visible : results[result] & visible;
  }
  check_that_loops_ended();
}
