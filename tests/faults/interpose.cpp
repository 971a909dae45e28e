// SPDX-License-Identifier: Apache-2.0
// Loaded before the C library (LD_PRELOAD) by tests: makes the n-th call of a function fail, or kills the process
// there, or keeps a driver's threads from working.
//   PENUMBRA_FAULT_CALL=write|fsync|linkat|rename|open   which calls count: on regular files (pwrite as write), and
//                                                        opens that create one
//   PENUMBRA_FAULT_AT=N                                  which of these calls fails, counted from 1
//   PENUMBRA_FAULT_ERRNO=E                               errno of the failure; 0: the process is killed there
//   PENUMBRA_FAULT_DEAF=NAME                             threads that a library with NAME in its path starts do nothing

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Returns whether this call is the one that fails; errno is set then.
bool fails(const char* call) {
  static std::atomic<long> count{0};
  const char* wanted = std::getenv("PENUMBRA_FAULT_CALL");
  const char* at = std::getenv("PENUMBRA_FAULT_AT");
  const char* how = std::getenv("PENUMBRA_FAULT_ERRNO");
  if (wanted == nullptr || at == nullptr || how == nullptr || std::strcmp(wanted, call) != 0) return false;
  if (++count != std::atol(at)) return false;
  if (std::atoi(how) == 0) kill(getpid(), SIGKILL);
  errno = std::atoi(how);
  return true;
}

bool is_regular(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

void* do_nothing(void*) {
  for (;;) pause();
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (is_regular(file) && fails("write")) return -1;
  return real(file, bytes, count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  if (is_regular(file) && fails("write")) return -1;
  return real(file, bytes, count, offset);
}

int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  if (is_regular(file) && fails("fsync")) return -1;
  return real(file);
}

int linkat(int from, const char* old_name, int to, const char* new_name, int flags) noexcept {
  static const auto real = next<int (*)(int, const char*, int, const char*, int)>("linkat");
  return fails("linkat") ? -1 : real(from, old_name, to, new_name, flags);
}

int rename(const char* old_name, const char* new_name) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails("rename") ? -1 : real(old_name, new_name);
}

int open(const char* name, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open");
  va_list more;
  va_start(more, flags);
  const bool creates = (flags & (O_CREAT | __O_TMPFILE)) != 0;
  const mode_t mode = creates ? va_arg(more, mode_t) : 0;
  va_end(more);
  return creates && fails("open") ? -1 : real(name, flags, mode);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  static const auto real = next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  const char* deaf = std::getenv("PENUMBRA_FAULT_DEAF");
  Dl_info caller{};
  if (deaf != nullptr && dladdr(__builtin_return_address(0), &caller) != 0 && caller.dli_fname != nullptr &&
      std::strstr(caller.dli_fname, deaf) != nullptr) {
    start = do_nothing;
  }
  return real(thread, attributes, start, argument);
}

}  // extern "C"
