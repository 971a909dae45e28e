// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra {

/// Memory that this process can still have, and the limit that sets it.
struct MemoryRoom {
  std::uint64_t bytes = 0;
  std::string limit;  ///< words that end a sentence: "this machine has left"
};

/// Returns the smallest of the machine's available memory, the allowance left in the process's control groups (v1 or
/// v2, from its own to the root), and the remainder of `ulimit -v` and `ulimit -d`. `root` is the parent of /proc and
/// /sys; other values are for tests.
MemoryRoom memory_room(const std::filesystem::path& root = "/");

/// Throws ResourceError "WHAT needs about 5.2 GiB of memory, more than the 3.1 GiB that …; REMEDY" before memory is
/// allocated: with overcommitment, allocating too much ends in a killed process, not in an error.
void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy);

/// Returns the largest resident set that this process has had; 0 if the system does not report it.
std::uint64_t peak_resident_bytes();

/// Makes the allocator keep freed memory instead of returning it to the system: a picture allocates its arrays again
/// and again, and page faults would dominate. (Large arrays: kept_arrays.hpp.) The C library's heap then lies in large
/// pages, unless addresses are limited to less than 2 GiB. Call it at the beginning of a process.
void keep_freed_memory();
/// Returns kept memory to the system.
void give_back_memory();

/// Formats a size: "1.5 GiB", "320 MiB", "12 bytes".
std::string in_bytes(std::uint64_t bytes);

}  // namespace penumbra
