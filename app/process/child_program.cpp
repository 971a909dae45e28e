// SPDX-License-Identifier: Apache-2.0
// Starts programs, reads their output, ends them.

#include "app/process/child_program.hpp"

#include "base/error.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::app {
namespace {

constexpr std::chrono::milliseconds kLook(10);  // interval of polling
constexpr std::chrono::seconds kPatience(10);   // time to end: a worker may be writing a picture to a slow disk
constexpr int kNotThere = 127;                  // exit code of a program that was not found, as in shells

}  // namespace

void ChildProgram::Said::read() {
  std::array<char, 4096> buffer{};
  while (pipe.read.is_open()) {
    const ssize_t count = ::read(pipe.read.get(), buffer.data(), buffer.size());
    if (count > 0)
      text.append(buffer.data(), static_cast<std::size_t>(count));
    else if (count == 0 || (errno != EINTR && errno != EAGAIN))
      pipe.read.close();
    else if (errno == EAGAIN)
      return;
  }
}

// Uses fork, not posix_spawn as base/child does, since the child must prepare itself before it runs the program: a
// worker must end with this process even if this process is killed, and signals that the user ignores (nohup) stay
// ignored.
pid_t ChildProgram::start(std::vector<std::string>& command, const Said& output, const Said& errors) {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  sigset_t none;
  ::sigemptyset(&none);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    throw ResourceError("cannot start {}: {}; raise the limit on processes (ulimit -u, the control group's pids.max)",
                        command.front(), std::generic_category().message(errno));
  }
  if (child == 0) {  // only this thread exists in the child: calls async-signal-safe functions only
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(static_cast<int>(ExitCode::interrupted));  // the parent has already ended
    ::dup2(nothing.get(), STDIN_FILENO);
    ::dup2(output.pipe.write.get(), STDOUT_FILENO);
    ::dup2(errors.pipe.write.get(), STDERR_FILENO);
    ::signal(SIGPIPE, SIG_DFL);  // ignored by prepare_process; signals ignored by the user stay ignored
    ::signal(SIGXFSZ, SIG_DFL);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execvp(argv.front(), argv.data());
    ::_exit(kNotThere);
  }
  return child;
}

ChildProgram::ChildProgram(std::vector<std::string> command)
    : said_{{make_pipe(), {}}, {make_pipe(), {}}}, child_(start(command, said_[0], said_[1])) {
  for (Said& said : said_) {
    said.pipe.write.close();
    ::fcntl(said.pipe.read.get(), F_SETFL, O_NONBLOCK);
  }
}

ChildProgram::~ChildProgram() {
  ask_to_end();
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!has_ended() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(kLook);
}

bool ChildProgram::has_ended() {
  const bool ended = child_.has_ended();  // first: output written before the end is then in the pipes
  for (Said& said : said_) said.read();
  return ended;
}

int ChildProgram::exit_code() {
  const int status = child_.wait();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

ProgramEnding run_program(std::vector<std::string> command) {
  ChildProgram program(std::move(command));
  while (!program.has_ended()) {
    session::check_interrupt();
    std::this_thread::sleep_for(kLook);
  }
  return {program.exit_code(), program.take_output(), program.take_errors()};
}

std::string own_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw ResourceError("cannot find the running program's file: {}", error.message());
  return self.string();
}

}  // namespace penumbra::app
