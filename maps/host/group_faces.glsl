// SPDX-License-Identifier: Apache-2.0
// Kernels of a receiver on all faces of its side, for the mains of group_kernel.glsl.
void look_at_faces() {
  for (uint number = 0; number < asked.side.face_count; ++number) {
    const MapFace face = face_of(asked.side, 0, lookup.size, number);
    Kernel kernel = kernel_of(face);
    look_at_kernel(face, kernel);
    for (uint turn = 1; !is_empty(kernel); ++turn) {
      kernel = next_kernel(face, turn);
      if (!is_empty(kernel)) look_at_kernel(face, kernel);
    }
  }
}
