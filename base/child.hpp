#pragma once

#include "base/descriptor.hpp"

#include <csignal>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra {

/// The two ends of a pipe; children get neither, unless they are given it under another number.
struct Pipe {
  Descriptor read, write;
};

/// Throws ResourceError if there can be none.
Pipe make_pipe();

/// A program to be started.
struct ChildCommand {
  std::vector<std::string> words;  ///< its file, and the arguments
  /// Open files of this process that are to be the child's 0, 1, 2 and so on. The child has no others: libraries of
  /// this process may have opened files without O_CLOEXEC (GPU drivers do).
  std::vector<int> files;
};

/// A child's number, or why there is none.
struct ChildStart {
  pid_t pid = -1;
  int error = 0;  ///< an errno; 0: it runs
};

/// Starts a program with default signal handling, whatever this process blocks or ignores. By posix_spawn, not by fork:
/// this process has threads (TBB, Vulkan drivers), whose locks a forked copy would inherit locked. ResourceError if the
/// files cannot be duplicated.
ChildStart start_child(const ChildCommand& command);

/// Owns a child process: it never outlives this object, and never stays behind as a zombie.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  /// Nothing if it has ended.
  void kill(int signal = SIGKILL) const;
  bool has_ended();
  /// The exit status as waitpid gives it.
  int wait();

 private:
  void reap(int options);
  pid_t pid_;
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace penumbra
