// SPDX-License-Identifier: Apache-2.0
// Prepares the process and explains exceptions.

#include "app/process/process.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "session/process/failure.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace penumbra::app {
namespace {

/// Opens /dev/null for closed standard streams: otherwise the next opened file would get the stream's number, and
/// printed text would be written to this file.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // stdout for reading only, so that writing results is an error; messages are dropped without an error.
    ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

[[noreturn]] void end_after_uncaught() noexcept {
  int code = static_cast<int>(ExitCode::resource);
  if (std::current_exception() != nullptr) {
    code = explain_current_exception();
  } else {
    say("penumbra: error: internal: std::terminate was called\n");
  }
  std::_Exit(code);
}

}  // namespace

void prepare_process() {
  keep_freed_memory();
  occupy_closed_streams();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(end_after_uncaught);
}

void say(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

int explain_current_exception() noexcept try {
  const session::Failure failure = session::describe_current_exception();
  say(fmt::format("penumbra: error: {}\n", failure.message));
  return static_cast<int>(failure.code);
} catch (...) {  // no memory even for the message
  say("penumbra: error: out of memory\n");
  return static_cast<int>(ExitCode::resource);
}

void check_stdout() {
  if (std::fflush(stdout) != 0)
    throw ResourceError("cannot write to stdout: {}", std::generic_category().message(errno));
  if (std::ferror(stdout) != 0) throw ResourceError("cannot write to stdout: an earlier write failed");
}

}  // namespace penumbra::app
