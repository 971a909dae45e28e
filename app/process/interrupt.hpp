#pragma once

#include "base/error.hpp"

namespace penumbra::app {

/// Thrown to end a command after SIGINT, SIGTERM or SIGHUP where it must unwind (UnwindsAfterSignals).
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::interrupted, "interrupted; no output file was left half-written") {}
};

/// Call once, first thing in main, before any other thread exists: from then on these signals are taken by a thread of
/// their own, which ends the process at once, whatever it is doing: temporary files are removed, and the exit code is
/// 130. (A signal that the caller chose to ignore stays ignored.) Throws std::system_error if there cannot be such a
/// thread.
void watch_for_interrupts();

/// Throws Interrupted if a signal came. Call it between steps of what must unwind.
void check_interrupt();

/// A stretch of work that ends by unwinding, or is short: a child process runs, or files get their names together.
/// While one is alive a signal does not end the process: the next check_interrupt() throws, or else the end of the last
/// one ends the process.
class UnwindsAfterSignals {
 public:
  UnwindsAfterSignals();
  ~UnwindsAfterSignals();
  UnwindsAfterSignals(const UnwindsAfterSignals&) = delete;
  UnwindsAfterSignals& operator=(const UnwindsAfterSignals&) = delete;
};

}  // namespace penumbra::app
