#pragma once

#include <tbb/parallel_for.h>

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
  const auto begin = (reinterpret_cast<std::uintptr_t>(list.data()) + kPage - 1) / kPage * kPage,
             end = reinterpret_cast<std::uintptr_t>(list.data() + count) / kPage * kPage;
  if (end > begin + kPiece) {
    tbb::parallel_for(std::size_t{0}, (end - begin + kPiece - 1) / kPiece, [&](std::size_t i) {
      const std::uintptr_t from = begin + i * kPiece, to = from + kPiece < end ? from + kPiece : end;
      // A system that does not know this gives pages later.
      static_cast<void>(::madvise(reinterpret_cast<void*>(from), to - from, MADV_POPULATE_WRITE));
    });
  }
  list.resize(count);
}

}  // namespace penumbra
