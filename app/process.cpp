#include "app/process.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace penumbra::app {
namespace {

/// A closed stream's number goes to the next file that is opened, and what is printed then ends up in it.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // stdout for reading only, so that results nobody can get are an error; messages nobody wants are none.
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

int fail(ExitCode code, std::string_view message) {
  say(fmt::format("penumbra: error: {}\n", message));
  return static_cast<int>(code);
}

std::string stdout_message(const std::string& reason) {
  return fmt::format("cannot write to stdout: {}", reason);
}

/// What an exception of a library means, as far as that can be told.
std::string explain(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (std::ferror(stdout) != 0) return stdout_message(system != nullptr ? system->code().message() : error.what());
  const bool no_thread = (system != nullptr && system->code() == std::errc::resource_unavailable_try_again) ||
                         std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
  if (no_thread) {
    return fmt::format(
        "cannot start a thread ({}); raise the limit on processes (ulimit -u, the control group's pids.max), or that "
        "on memory (ulimit -v)",
        error.what());
  }
  // No library's exception should come this far; if one does, it is ours to repair, and no crash for the user.
  return fmt::format("internal: {}", error.what());
}

}  // namespace

void prepare_process() {
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
  try {
    throw;
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    // How much there was cannot be told any more: unwinding has given back what was taken.
    const MemoryRoom room = memory_room();
    return fail(ExitCode::resource, fmt::format("out of memory ({} is all that {}, now that everything is given back); "
                                                "choose a smaller --size, fewer --light-samples or a smaller scene",
                                                in_bytes(room.bytes), room.limit));
  } catch (const std::exception& error) {
    return fail(ExitCode::resource, explain(error));
  }
} catch (...) {  // no memory left even for the message
  say("penumbra: error: out of memory\n");
  return static_cast<int>(ExitCode::resource);
}

void check_stdout() {
  if (std::fflush(stdout) != 0) throw ResourceError("{}", stdout_message(std::generic_category().message(errno)));
  if (std::ferror(stdout) != 0) throw ResourceError("{}", stdout_message("an earlier write failed"));
}

}  // namespace penumbra::app
