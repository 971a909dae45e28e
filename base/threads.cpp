// SPDX-License-Identifier: Apache-2.0
// Starts a number of idle threads and ends them again, to learn in advance whether the system's limits allow them:
// libraries that cannot start their threads wait forever, or end the process.

#include "base/threads.hpp"

#include "base/error.hpp"

#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace penumbra {

void require_threads(unsigned count, std::string_view what) {
  std::latch end(1);
  std::vector<std::jthread> threads;
  threads.reserve(count);
  std::string reason;
  try {
    while (threads.size() < count) threads.emplace_back([&end] { end.wait(); });
  } catch (const std::system_error& error) {
    reason = error.code().message();
  }
  end.count_down();
  if (threads.size() == count) return;
  throw ResourceError(
      "{} needs {} more threads, and only {} could be started: {}; raise the limit (ulimit -u, the control group's "
      "pids.max), or that on memory (ulimit -v)",
      what, count, threads.size(), reason);
}

}  // namespace penumbra
