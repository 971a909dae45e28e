// SPDX-License-Identifier: Apache-2.0
// Sandbox of helper processes: end with the parent, no new files, no children, limits on memory and time.

#include "mesh/helper_process.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

namespace penumbra::mesh {
namespace {

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);  // fails only where a lower limit is in force already
}

/// Makes this process end with its parent, at whatever moment the parent is killed; returns false if the parent is gone
/// already. Standard input is a pipe whose other end only the parent has.
bool end_with_asker(std::uint64_t asker) {
  // Two mechanisms, since each has a gap: the first is bound to the parent's thread; for the second, another child of
  // the parent may briefly hold the pipe's other end.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent ended before prctl, so that no signal will come.
  if (static_cast<std::uint64_t>(::getppid()) != asker) return false;
  const int pipe = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (pipe < 0 || nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0) return false;
  ::close(nothing);
  ::fcntl(pipe, F_SETOWN, ::getpid());
  ::fcntl(pipe, F_SETSIG, SIGKILL);
  ::fcntl(pipe, F_SETFL, O_ASYNC);  // SIGKILL when the other end closes …
  pollfd state{pipe, POLLIN, 0};
  return ::poll(&state, 1, 0) == 0;  // … unless it did so before
}

/// Restricts this process to reading files and writing its answer.
void confine(const HelperTerms& terms) {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // this process writes to a pipe only
  limit(RLIMIT_NOFILE, 64);
  if (terms.milliseconds)
    limit(RLIMIT_CPU, *terms.milliseconds / 1000 + 2);  // fallback: the parent's deadline comes first, unless the
                                                        // parent has died
#if !defined(PENUMBRA_SHADOW_MEMORY)
  if (terms.memory_bytes) {
    limit(RLIMIT_AS, *terms.memory_bytes);
    limit(RLIMIT_NPROC, 0);  // no threads, no children
  }
#endif
}

}  // namespace

int begin_helper(const HelperTerms& terms) {
  // Done first, before there is anything to lose.
  if (!end_with_asker(terms.asker)) ::_exit(static_cast<int>(ExitCode::interrupted));
  const int output = ::dup(STDOUT_FILENO);
  if (output < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) ::_exit(static_cast<int>(ExitCode::resource));
  confine(terms);
  return output;
}

WireWriter answer_head(HelperStatus status) {
  WireWriter head;
  for (const char c : kHelperMagic) head.put(c);
  head.put(static_cast<std::uint8_t>(status));
  return head;
}

}  // namespace penumbra::mesh
