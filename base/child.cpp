#include "base/child.hpp"

#include "base/error.hpp"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra {

Pipe make_pipe() {
  const auto reason = [] { return std::generic_category().message(errno); };
  std::array<int, 2> fds{};
  if (::pipe2(fds.data(), O_CLOEXEC) != 0) throw ResourceError("cannot make a pipe: {}", reason());
  Pipe pipe{Descriptor(fds[0]), Descriptor(fds[1])};
  // If this program was started without standard streams, the ends may have got the numbers 0 to 2, which the child's
  // own redirections are about to overwrite one after the other: move them out of the way.
  for (Descriptor* end : {&pipe.read, &pipe.write}) {
    if (end->get() > 2) continue;
    const int moved = ::fcntl(end->get(), F_DUPFD_CLOEXEC, 3);
    if (moved < 0) throw ResourceError("cannot duplicate a file descriptor: {}", reason());
    *end = Descriptor(moved);
  }
  return pipe;
}

Child::~Child() {
  kill();
  wait();
}

void Child::kill(int signal) const {
  if (!ended_) ::kill(pid_, signal);  // not reaped yet, so the number is still its own
}

bool Child::has_ended() {
  reap(WNOHANG);
  return ended_;
}

int Child::wait() {
  reap(0);
  return status_;
}

void Child::reap(int options) {
  while (!ended_) {
    const pid_t result = ::waitpid(pid_, &status_, options);
    if (result == 0) return;
    // ECHILD: somebody ignores SIGCHLD, so the kernel reaped it; what it leaves behind says whether it did its work.
    ended_ = result == pid_ || errno != EINTR;
  }
}

}  // namespace penumbra
