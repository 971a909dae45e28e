#pragma once

#include "base/error.hpp"

namespace penumbra::app {

/// What ends a command after SIGINT, SIGTERM or SIGHUP: unwinding removes the temporary files of outputs not yet whole.
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::interrupted, "interrupted; no output file was left half-written") {}
};

/// Call once, first thing in main, before any other thread exists: from then on these signals are taken by a thread
/// of their own. (A signal that the caller chose to ignore stays ignored.) Throws std::system_error if there cannot be
/// such a thread.
void watch_for_interrupts();

/// Throws Interrupted if a signal came. Call it between steps.
void check_interrupt();

/// A stretch of work that may take long and polls nothing: while one is alive and no output file is open (FileIsOpen),
/// a signal ends the process immediately. Otherwise the next check_interrupt() throws.
class MayExitAtOnce {
 public:
  MayExitAtOnce();
  ~MayExitAtOnce();
  MayExitAtOnce(const MayExitAtOnce&) = delete;
  MayExitAtOnce& operator=(const MayExitAtOnce&) = delete;
};

/// Lives as long as an output file that work is still being put into: its temporary must be removed by unwinding.
class FileIsOpen {
 public:
  FileIsOpen();
  ~FileIsOpen();
  FileIsOpen(const FileIsOpen&) = delete;
  FileIsOpen& operator=(const FileIsOpen&) = delete;
};

}  // namespace penumbra::app
