// SPDX-License-Identifier: Apache-2.0
// Memory available to this process (machine, control groups, resource limits), and settings of the C library's
// allocator.

#include "base/memory.hpp"

#include "base/error.hpp"
#include "base/kept_arrays.hpp"
#include "base/pages.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace penumbra {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> parse_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end == text.data()) return std::nullopt;  // "max", or no such file
  return value;
}

/// Returns the number at the start of a file that has one number.
std::optional<std::uint64_t> number_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string text;
  stream >> text;
  return parse_number(text);
}

/// Returns the number behind `key` in a file of lines "KEY NUMBER" or "KEY: NUMBER kB".
std::optional<std::uint64_t> number_of(const std::filesystem::path& file, std::string_view key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name, value;
    words >> name >> value;
    if (name.ends_with(':')) name.pop_back();
    if (name == key) return parse_number(value);
  }
  return std::nullopt;
}

/// File names of one version of control groups.
struct GroupFiles {
  const char* limit;
  const char* usage;
  const char* prefix;  ///< prefix of keys in memory.stat that count the whole subtree
};
constexpr GroupFiles kVersion1 = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_"};
constexpr GroupFiles kVersion2 = {"memory.max", "memory.current", ""};

/// Returns the memory that one group has left. Cached file pages count as free, since the kernel reclaims them before
/// it refuses memory.
std::uint64_t room_of_group(const std::filesystem::path& folder, const GroupFiles& files) {
  const auto limit = number_in(folder / files.limit), usage = number_in(folder / files.usage);
  if (!limit || !usage) return kUnlimited;
  std::uint64_t used = *usage;
  for (const char* key : {"inactive_file", "active_file"}) {
    used -= std::min(used, number_of(folder / "memory.stat", std::string(files.prefix) + key).value_or(0));
  }
  return *limit - std::min(*limit, used);
}

/// Returns the least memory that a group and its ancestors have left. In a container `path` may be the host's, which is
/// not visible there: then only the mount's own root counts.
std::uint64_t room_of_groups(const std::filesystem::path& mount, std::string path, const GroupFiles& files) {
  std::uint64_t room = room_of_group(mount, files);
  while (path.size() > 1) {
    room = std::min(room, room_of_group(mount / path.substr(1), files));
    path.erase(path.rfind('/'));
  }
  return room;
}

#ifdef __GLIBC__
/// Arrays of at least this many bytes do not lie in the heap: they begin at large pages, and in the heap the gaps
/// between them would lie idle (half of the largest resident set of a picture in bands). kept_arrays() caches them.
constexpr int kLeastOutsideHeap = KeptArrays::kLeast;
std::atomic<bool> heap_lies_in_large_pages = false;

/// Grows the C library's heap by a piece of address space, and asks the system for large pages there, so that a
/// picture's small arrays do not cost a page fault for each 4 KiB. Memory is taken only where it is written. (glibc
/// does this itself for a process that is started with GLIBC_TUNABLES=glibc.malloc.hugetlb=1.) Does nothing where the
/// address space is limited, since the piece counts toward the limit.
void lay_heap_in_large_pages() {
  constexpr int kPiece = 1 << 27;
  constexpr rlim_t kPlenty = rlim_t{16} * kPiece;
  const auto is_scarce = [](__rlimit_resource resource) {
    rlimit limit{};
    return ::getrlimit(resource, &limit) != 0 || limit.rlim_cur < kPlenty;
  };
  if (is_scarce(RLIMIT_AS) || is_scarce(RLIMIT_DATA)) return;
  static char* const begin = static_cast<char*>(::sbrk(0));
  ::mallopt(M_TOP_PAD, kPiece);
  // Larger than the heap's free memory, and smaller than arrays outside of the heap. (volatile: the compiler keeps the
  // allocation.)
  void* volatile more = std::malloc(kLeastOutsideHeap - (1 << 16));
  std::free(more);
  char* const end = static_cast<char*>(::sbrk(0));
  const std::size_t to_page = (kLargePage - reinterpret_cast<std::uintptr_t>(begin) % kLargePage) % kLargePage;
  if (begin + to_page < end)
    static_cast<void>(::madvise(begin + to_page, static_cast<std::size_t>(end - begin) - to_page, MADV_HUGEPAGE));
}
#endif

std::uint64_t room_of_control_groups(const std::filesystem::path& root) {
  std::uint64_t room = kUnlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // NUMBER:CONTROLLERS:PATH
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") {
      room = std::min(room, room_of_groups(root / "sys/fs/cgroup", path, kVersion2));
    } else if (controllers.find(",memory,") != std::string::npos) {
      room = std::min(room, room_of_groups(root / "sys/fs/cgroup/memory", path, kVersion1));
    }
  }
  return room;
}

/// Returns the address space that a resource limit leaves; `column` is the column of /proc/self/statm, which counts
/// pages.
std::uint64_t room_of_limit(const std::filesystem::path& root, __rlimit_resource resource, int column) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  std::ifstream statm(root / "proc/self/statm");
  std::uint64_t pages = 0;
  for (int i = 0; i <= column; ++i) statm >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

}  // namespace

MemoryRoom memory_room(const std::filesystem::path& root) {
  MemoryRoom room{kUnlimited, "this machine has left"};
  const auto at_most = [&](std::uint64_t bytes, const char* limit) {
    if (bytes < room.bytes) room = {bytes, limit};
  };
  if (const auto kibibytes = number_of(root / "proc/meminfo", "MemAvailable")) {
    at_most(*kibibytes * 1024, "this machine has left");
  } else {  // no /proc
    at_most(static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
            "this machine has");
  }
  at_most(room_of_control_groups(root), "the process's control group leaves");
  at_most(room_of_limit(root, RLIMIT_AS, 0), "the limit on addresses (ulimit -v) leaves");
  at_most(room_of_limit(root, RLIMIT_DATA, 5), "the limit on data (ulimit -d) leaves");
  return room;
}

void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy) {
  constexpr std::uint64_t kAlwaysTried = 16u << 20;  // below this the check costs more than it saves, and a failure is
                                                     // an ordinary bad_alloc
  if (bytes <= kAlwaysTried) return;
  MemoryRoom room = memory_room();
  if (bytes <= room.bytes) return;
  give_back_memory();
  room = memory_room();
  if (bytes <= room.bytes) return;
  throw ResourceError("{} needs about {} of memory, more than the {} that {}; {}", what, in_bytes(bytes),
                      in_bytes(room.bytes), room.limit, remedy);
}

std::uint64_t peak_resident_bytes() {
  // VmHWM covers this program alone: getrusage's figure starts at the size of the process that started it.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) << 10U;  // in KiB
  }
  return 0;
}

void give_back_memory() {
  kept_arrays().free_all();
#ifdef __GLIBC__
  ::malloc_trim(0);
  if (heap_lies_in_large_pages) lay_heap_in_large_pages();  // trimming has released that piece of the heap
#endif
}

void keep_freed_memory() {
  kept_arrays().start_keeping();
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, kLeastOutsideHeap);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  heap_lies_in_large_pages = true;
  lay_heap_in_large_pages();
#endif
}

std::string in_bytes(std::uint64_t bytes) {
  constexpr double kMebi = 1u << 20, kGibi = 1u << 30;
  const auto value = static_cast<double>(bytes);
  if (value >= kGibi) return fmt::format("{:.3g} GiB", value / kGibi);
  if (value >= kMebi) return fmt::format("{:.3g} MiB", value / kMebi);
  if (value >= 1024) return fmt::format("{:.3g} KiB", value / 1024);
  return fmt::format("{} bytes", bytes);
}

}  // namespace penumbra
