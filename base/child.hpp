#pragma once

#include "base/descriptor.hpp"

#include <csignal>

#include <sys/types.h>

namespace penumbra {

/// The two ends of a pipe; children get neither, unless they are given it under another number.
struct Pipe {
  Descriptor read, write;
};

/// Throws ResourceError if there can be none.
Pipe make_pipe();

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
