// SPDX-License-Identifier: Apache-2.0
// Child processes by posix_spawn: start, wait, kill.

#include "base/child.hpp"

#include "base/error.hpp"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra {
namespace {

std::string reason() {
  return std::generic_category().message(errno);
}

/// The two argument objects (file actions and attributes) that posix_spawn needs for a command's files.
class SpawnSettings {
 public:
  explicit SpawnSettings(const std::vector<int>& files) {
    const auto count = static_cast<int>(files.size());
    std::vector<int> from = files;
    for (int& file : from) {  // moved above all numbers that the child's files will get, so that no file overwrites
                              // another
      if (file >= count) continue;
      copies_.emplace_back(::fcntl(file, F_DUPFD_CLOEXEC, count));
      if (!copies_.back().is_open()) throw ResourceError("cannot duplicate a file descriptor: {}", reason());
      file = copies_.back().get();
    }
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawnattr_init(&attributes_);
    for (int i = 0; i < count; ++i) ::posix_spawn_file_actions_adddup2(&actions_, from[static_cast<std::size_t>(i)], i);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, count);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }
  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  std::vector<Descriptor> copies_;
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ChildStart start_child(const ChildCommand& command) {
  std::vector<std::string> words = command.words;
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const SpawnSettings settings(command.files);
  ChildStart start;
  start.error = ::posix_spawn(&start.pid, argv[0], settings.actions(), settings.attributes(), argv.data(), ::environ);
  return start;
}

Pipe make_pipe() {
  std::array<int, 2> fds{};
  if (::pipe2(fds.data(), O_CLOEXEC) != 0) throw ResourceError("cannot make a pipe: {}", reason());
  Pipe pipe{Descriptor(fds[0]), Descriptor(fds[1])};
  // If this program was started without standard streams, the ends may have got the numbers 0 to 2, which the child's
  // redirections will overwrite one after the other: the ends are moved to higher numbers.
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
  if (!ended_) ::kill(pid_, signal);  // not reaped yet, so the process number still belongs to the child
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
    // ECHILD: SIGCHLD is ignored in this process, so the kernel reaped the child; the child's output shows whether the
    // child succeeded.
    ended_ = result == pid_ || errno != EINTR;
  }
}

}  // namespace penumbra
