// SPDX-License-Identifier: Apache-2.0
// Reads processor, memory and operating system from /proc and /etc.

#include "compare/machine.hpp"

#include <fstream>
#include <string_view>

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace penumbra::compare {
namespace {

/// Returns the value of the first line "key<separator>value", without blanks and quotes around it.
std::string value_in_file(const char* path, std::string_view key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find(separator);
    if (!line.starts_with(key) || at == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    if (first != std::string::npos && first <= last) return line.substr(first, last - first + 1);
  }
  return {};
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.processor = value_in_file("/proc/cpuinfo", "model name", ':');
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) == 0)
    machine.threads = static_cast<unsigned>(CPU_COUNT(&allowed));
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_size = ::sysconf(_SC_PAGESIZE);
  if (pages > 0 && page_size > 0) {
    machine.memory_bytes = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_size);
  }
  machine.operating_system = value_in_file("/etc/os-release", "PRETTY_NAME", '=');
  if (utsname kernel{}; ::uname(&kernel) == 0) {
    if (!machine.operating_system.empty()) machine.operating_system += ", ";
    machine.operating_system += std::string(kernel.sysname) + " " + kernel.release + " " + kernel.machine;
  }
  return machine;
}

}  // namespace penumbra::compare
