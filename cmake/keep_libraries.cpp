// Drivers and layers stay loaded, so that the leak checker knows where their frames are and can tell theirs from ours
// (tests/sanitizers/leak.supp). Linked into every program of a build with AddressSanitizer; visible, so that libraries
// call it too.

extern "C" __attribute__((visibility("default"))) int dlclose(void* /*handle*/) noexcept {
  return 0;
}
