#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra {

/// How much more memory this process can have, and what sets the limit.
struct MemoryRoom {
  std::uint64_t bytes = 0;
  std::string limit;  ///< in words that end a sentence: "this machine has left"
};

/// The smallest of what the machine has available, what the process's control groups (v1 or v2, from its own to the
/// root) allow beyond what they use, and what `ulimit -v` and `ulimit -d` leave. `root` is where /proc and /sys are
/// looked up: another one is for tests.
MemoryRoom memory_room(const std::filesystem::path& root = "/");

/// Says no before memory is asked for: with overcommitment, asking too much ends in a killed process, not in an error.
/// ResourceError "WHAT needs about 5.2 GiB of memory, more than the 3.1 GiB that …; REMEDY".
void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy);

/// The most memory that this process has had in use at once (its largest resident set); 0: the system does not say.
std::uint64_t peak_resident_bytes();

/// Memory that is given back stays the process's: the system gives pages slowly, a picture asks for its arrays again
/// and again, and then ends. (Large arrays: kept_arrays.hpp.)
void keep_freed_memory();
/// What has stayed goes back to the system.
void give_back_memory();

/// "1.5 GiB", "320 MiB", "12 bytes".
std::string in_bytes(std::uint64_t bytes);

}  // namespace penumbra
