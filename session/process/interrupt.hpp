// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"

namespace penumbra::session {

/// Thrown after SIGINT, SIGTERM or SIGHUP to end a command that must unwind (UnwindsAfterSignals).
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::interrupted, "interrupted; no output file was left half-written") {}
};

/// Starts a thread that receives these signals and ends the process at once, at any time: temporary files are removed,
/// and the exit code is 130. To be called once, first in main, before any other thread exists. (A signal ignored by the
/// caller stays ignored.) Throws std::system_error if the thread cannot be created.
void watch_for_interrupts();

/// Throws Interrupted if a signal has arrived. To be called between steps of work that must unwind.
void check_interrupt();

/// Marks a section of work that ends by unwinding, or is short: a child process runs, or files get their names
/// together. During its lifetime a signal does not end the process: the next check_interrupt() throws, or else the end
/// of the last section ends the process.
class UnwindsAfterSignals {
 public:
  UnwindsAfterSignals();
  ~UnwindsAfterSignals();
  UnwindsAfterSignals(const UnwindsAfterSignals&) = delete;
  UnwindsAfterSignals& operator=(const UnwindsAfterSignals&) = delete;
};

}  // namespace penumbra::session
