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

/// Sees to it that this process ends with the one that asked, at whatever moment that is killed; false: it is gone
/// already. Standard input is a pipe whose other end only the asker has.
bool end_with_asker(std::uint64_t asker) {
  // Two ways, since each has its hole: the first is bound to the thread that asked; for the second, another child of
  // the asker may for a moment hold the pipe's other end.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (static_cast<std::uint64_t>(::getppid()) != asker) return false;  // it died before, so that no signal will come
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

/// From here on this process can read files and answer, and not much more.
void confine(const HelperTerms& terms) {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // it writes to a pipe only
  limit(RLIMIT_NOFILE, 64);
  if (terms.milliseconds)
    limit(RLIMIT_CPU, *terms.milliseconds / 1000 + 2);  // the asker's clock comes first, unless it has died
#if !defined(PENUMBRA_SHADOW_MEMORY)
  if (terms.memory_bytes) {
    limit(RLIMIT_AS, *terms.memory_bytes);
    limit(RLIMIT_NPROC, 0);  // no threads, no children
  }
#endif
}

}  // namespace

int begin_helper(const HelperTerms& terms) {
  // First of all, while nothing is to be lost.
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
