// SPDX-License-Identifier: Apache-2.0
// Reads the start of the process from the system.

#include "session/process/process_clock.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <unistd.h>

namespace penumbra::session {
namespace {

double boot_clock() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Returns the start on the boot clock: field 22 of proc(5)'s stat, in ticks. The second field, a name in brackets, may
/// contain any characters.
double start_of_process() {
  std::ifstream file("/proc/self/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::istringstream fields(text.substr(std::min(text.rfind(')'), text.size() - 1) + 1));
  std::string field;
  for (int number = 3; number < 22; ++number) fields >> field;
  double ticks = 0;
  return fields >> ticks ? ticks / static_cast<double>(::sysconf(_SC_CLK_TCK)) : boot_clock();
}

}  // namespace

double seconds_since_start() {
  static const double start = start_of_process();
  return std::max(boot_clock() - start, 0.0);
}

}  // namespace penumbra::session
