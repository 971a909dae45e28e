// SPDX-License-Identifier: Apache-2.0
// Keeps drivers and layers loaded, so that the leak checker can resolve their frames and distinguish them from
// Penumbra's (tests/sanitizers/leak.supp). Linked into every program of a build with AddressSanitizer; visible, so that
// libraries also call these functions.

extern "C" __attribute__((visibility("default"))) int dlclose(void* /*handle*/) noexcept {
  return 0;
}
