// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <sys/mman.h>

namespace penumbra {

/// Size of a large page on most processors: the system provides one in a fraction of the time of its 512 small pages.
constexpr std::size_t kLargePage = std::size_t{1} << 21U;

/// Arrays of at least this many bytes begin at a large page and lie in large pages where the system has some: pages.cpp
/// replaces `operator new` for this purpose, so this holds for every list, also in libraries. (Not under address and
/// thread sanitizer.)
constexpr std::size_t kLargeArray = 2 * kLargePage;

/// Allocator for lists that all cores write before any thread reads: resize() leaves plain values uninitialised, even
/// if their members have initialisers, so that each page is first touched by the thread that writes it.
template <typename Value>
struct PageAllocator : std::allocator<Value> {
  PageAllocator() = default;
  template <typename Other>
  explicit(false) PageAllocator(const PageAllocator<Other>& /*other*/) {}

  template <typename Other, typename... Arguments>
  void construct(Other* at, Arguments&&... arguments) {
    constexpr bool kIsPlain = std::is_trivially_copyable_v<Other> && std::is_trivially_destructible_v<Other>;
    if constexpr (sizeof...(arguments) > 0 || !kIsPlain) {
      ::new (static_cast<void*>(at)) Other(std::forward<Arguments>(arguments)...);
    }
  }
};

/// A list whose new values are uninitialised (PageAllocator).
template <typename Value>
using UnsetList = std::vector<Value, PageAllocator<Value>>;

/// Does list.resize(count) for an empty list that all cores will fill: all cores also page in its memory, which takes
/// longer than writing it.
template <typename Value>
void resize_on_all_cores(std::vector<Value>& list, std::size_t count) {
  constexpr std::size_t kPage = 4096, kPiece = 2 * kLargePage;
  list.reserve(count);
  const std::size_t bytes = count * sizeof(Value),
                    to_page = (kPage - reinterpret_cast<std::uintptr_t>(list.data()) % kPage) % kPage;
  const std::size_t whole =
      bytes > to_page ? (bytes - to_page) / kPage * kPage : 0;  // bytes in pages that belong to the list alone
  if (whole > kPiece) {
    char* const first = reinterpret_cast<char*>(list.data()) + to_page;
    tbb::parallel_for(std::size_t{0}, (whole + kPiece - 1) / kPiece, [&](std::size_t i) {
      const std::size_t from = i * kPiece;
      // On a system without MADV_POPULATE_WRITE the pages are provided later.
      static_cast<void>(::madvise(first + from, std::min(kPiece, whole - from), MADV_POPULATE_WRITE));
    });
  }
  list.resize(count);
}

}  // namespace penumbra
