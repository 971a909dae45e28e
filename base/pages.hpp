#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sys/mman.h>

namespace penumbra {

/// list.resize(count) of an empty list that is filled on all cores: they also ask for its memory, which the system
/// gives page by page, and which takes longer than writing it.
template <typename Value>
void resize_on_all_cores(std::vector<Value>& list, std::size_t count) {
  constexpr std::size_t kPage = 4096, kPiece = std::size_t{1} << 22U;
  list.reserve(count);
  const std::size_t bytes = count * sizeof(Value),
                    to_page = (kPage - reinterpret_cast<std::uintptr_t>(list.data()) % kPage) % kPage;
  const std::size_t whole =
      bytes > to_page ? (bytes - to_page) / kPage * kPage : 0;  // of pages that are the list's alone
  if (whole > kPiece) {
    char* const first = reinterpret_cast<char*>(list.data()) + to_page;
    tbb::parallel_for(std::size_t{0}, (whole + kPiece - 1) / kPiece, [&](std::size_t i) {
      const std::size_t from = i * kPiece;
      // A system that does not know this gives pages later.
      static_cast<void>(::madvise(first + from, std::min(kPiece, whole - from), MADV_POPULATE_WRITE));
    });
  }
  list.resize(count);
}

}  // namespace penumbra
