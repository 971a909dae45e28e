// SPDX-License-Identifier: Apache-2.0
// The heap of the program's processes lies in large pages, also after freed memory has been given back to the system.
#include "base/memory.hpp"
#include "base/pages.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <sys/mman.h>

namespace penumbra {
namespace {

/// Returns whether the system provides large pages where a process asks for them.
bool has_large_pages() {
  void* const piece = ::mmap(nullptr, kLargePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const bool has = piece != MAP_FAILED && ::madvise(piece, kLargePage, MADV_HUGEPAGE) == 0;
  if (piece != MAP_FAILED) ::munmap(piece, kLargePage);
  return has;
}

/// Returns whether the mapping that contains the address is marked for large pages ("hg" among its flags).
bool is_marked(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  bool is_here = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t first = 0, end = 0;
    char dash = 0;
    std::istringstream words(line);
    if (words >> std::hex >> first >> dash >> end && dash == '-') is_here = first <= wanted && wanted < end;
    if (is_here && line.starts_with("VmFlags:")) return line.find(" hg") != std::string::npos;
  }
  return false;
}

TEST(LargeHeap, HoldsWhatIsAllocatedAfterItsBeginning) {
#if defined(PENUMBRA_SHADOW_MEMORY) || !defined(__GLIBC__)
  GTEST_SKIP() << "another allocator";
#else
  if (!has_large_pages()) GTEST_SKIP() << "the system has no large pages";
  keep_freed_memory();
  // The second round is after the heap's end was given back to the system.
  for (const char* when : {"at first", "after memory was given back"}) {
    std::vector<void*> blocks;  // more than one large page, in blocks larger than any free list of the heap has
    for (int i = 0; i < 32; ++i) blocks.push_back(std::malloc(std::size_t{1} << 20U));
    EXPECT_TRUE(is_marked(blocks.back())) << when;
    for (void* block : blocks) std::free(block);
    give_back_memory();
  }
#endif
}

}  // namespace
}  // namespace penumbra
