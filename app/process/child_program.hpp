// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/child.hpp"
#include "session/process/interrupt.hpp"

#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {

/// Program started by this one. The child ends with this object, and with the thread that started it, however that
/// thread ends (so also with this process, even if killed). Its standard input is empty.
class ChildProgram {
 public:
  /// `command`: the program, found as by a shell, and its arguments. Throws ResourceError if no process can be created;
  /// a program that does not exist ends with 127.
  explicit ChildProgram(std::vector<std::string> command);
  /// Requests the program's end, and kills it after a few seconds.
  ~ChildProgram();

  /// Sends SIGTERM.
  void ask_to_end() const { child_.kill(SIGTERM); }
  /// Reads all output available now. Returns whether the program has ended; then all of its output has been read.
  bool has_ended();
  /// Returns the exit code of an ended program: 128 + signal if ended by a signal.
  [[nodiscard]] int exit_code();
  /// Return the output, and the errors, since the last call.
  std::string take_output() { return std::exchange(said_[0].text, {}); }
  std::string take_errors() { return std::exchange(said_[1].text, {}); }

 private:
  struct Said {
    Pipe pipe;
    std::string text;
    void read();
  };
  static pid_t start(std::vector<std::string>& command, const Said& output, const Said& errors);

  session::UnwindsAfterSignals unwinds_;
  Said said_[2];  // output, errors
  Child child_;
};

/// Result of a program that ran to its end.
struct ProgramEnding {
  int code = 0;
  std::string output, errors;
};

/// Runs a program to its end. Throws Interrupted after a signal.
ProgramEnding run_program(std::vector<std::string> command);

/// Returns this program's own file.
std::string own_program();

}  // namespace penumbra::app
