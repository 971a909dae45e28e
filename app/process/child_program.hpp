#pragma once

#include "app/process/interrupt.hpp"
#include "base/child.hpp"

#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {

/// A program that this one started. It ends with this object, and with the thread that started it, however that ends
/// (so with this process, even if that is killed). It gets nothing on its standard input.
class ChildProgram {
 public:
  /// `command`: the program, found as a shell would find it, and its arguments. Throws ResourceError if there can be no
  /// more processes; one that is not there ends with 127.
  explicit ChildProgram(std::vector<std::string> command);
  /// Asks it to end, and after a few seconds makes it.
  ~ChildProgram();

  /// SIGTERM.
  void ask_to_end() const { child_.kill(SIGTERM); }
  /// Reads what it has said by now. Has it ended? Then all that it said has been read.
  bool has_ended();
  /// Of one that has ended: 128 + signal if a signal ended it.
  [[nodiscard]] int exit_code();
  /// What came since the last call.
  std::string take_output() { return std::exchange(said_[0].text, {}); }
  std::string take_errors() { return std::exchange(said_[1].text, {}); }

 private:
  struct Said {
    Pipe pipe;
    std::string text;
    void read();
  };
  static pid_t start(std::vector<std::string>& command, const Said& output, const Said& errors);

  UnwindsAfterSignals unwinds_;
  Said said_[2];  // output, errors
  Child child_;
};

/// What a program left behind that ran to its end.
struct ProgramEnding {
  int code = 0;
  std::string output, errors;
};

/// Runs one to its end. Throws Interrupted after a signal.
ProgramEnding run_program(std::vector<std::string> command);

/// This program's own file.
std::string own_program();

}  // namespace penumbra::app
