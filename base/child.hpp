// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/descriptor.hpp"

#include <csignal>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra {

/// The two ends of a pipe; children inherit neither, unless ChildCommand::files gives them an end under another number.
struct Pipe {
  Descriptor read, write;
};

/// Throws ResourceError if no pipe can be made.
Pipe make_pipe();

/// A program to be started.
struct ChildCommand {
  std::vector<std::string> words;  ///< program file, then the arguments
  /// Open files of this process that become the child's 0, 1, 2 and so on. The child gets no others: libraries of this
  /// process may have opened files without O_CLOEXEC (GPU drivers do).
  std::vector<int> files;
};

/// The child's process number, or the reason why it could not be started.
struct ChildStart {
  pid_t pid = -1;
  int error = 0;  ///< errno; 0 if the child runs
};

/// Starts a program with default signal handling, regardless of the signals that this process blocks or ignores. Uses
/// posix_spawn instead of fork: this process has threads (TBB, Vulkan drivers), whose locks a forked copy would inherit
/// locked. Throws ResourceError if the files cannot be duplicated.
ChildStart start_child(const ChildCommand& command);

/// Owns a child process, which never outlives this object and never stays behind as a zombie.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  /// Does nothing if the child has ended.
  void kill(int signal = SIGKILL) const;
  bool has_ended();
  /// Returns the exit status as waitpid reports it.
  int wait();

 private:
  void reap(int options);
  pid_t pid_;
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace penumbra
