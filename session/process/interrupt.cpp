// SPDX-License-Identifier: Apache-2.0
// Ends the process on signals, from a separate thread.

#include "session/process/interrupt.hpp"

#include "base/atomic_file.hpp"

#include <atomic>
#include <csignal>
#include <exception>
#include <mutex>
#include <thread>

#include <pthread.h>
#include <unistd.h>

namespace penumbra::session {
namespace {

// A signal concerns the whole process, and so does this state: the only global of this program.
std::atomic<bool> g_interrupted{false};
std::mutex g_mutex;  // held while the process ends, so that no section that must unwind can begin
int g_unwinding = 0;

/// Ends the process without exit(), whose handlers would destroy data used by working threads.
[[noreturn]] void end_at_once() {
  remove_unfinished_files();
  constexpr char kText[] = "penumbra: interrupted\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kText, sizeof(kText) - 1);
  ::_exit(static_cast<int>(ExitCode::interrupted));
}

[[noreturn]] void wait_for_signals(sigset_t signals) {
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    g_interrupted = true;
    const std::lock_guard lock(g_mutex);
    if (g_unwinding == 0) end_at_once();
  }
}

}  // namespace

void watch_for_interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction current {};
    if (sigaction(signal, nullptr, &current) == 0 && current.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  // Threads inherit the mask: only the watching thread receives these signals.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(wait_for_signals, signals).detach();
}

void check_interrupt() {
  if (g_interrupted) throw Interrupted();
}

UnwindsAfterSignals::UnwindsAfterSignals() {
  check_interrupt();
  const std::lock_guard lock(g_mutex);
  ++g_unwinding;
}

UnwindsAfterSignals::~UnwindsAfterSignals() {
  const std::lock_guard lock(g_mutex);
  if (--g_unwinding == 0 && g_interrupted && std::uncaught_exceptions() == 0) end_at_once();
}

}  // namespace penumbra::session
