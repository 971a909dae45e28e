// SPDX-License-Identifier: Apache-2.0
// Pages of a set of triangles: added by the thread that sets the first bit of a page, and counted.

#include "visibility/seen/triangle_bits.hpp"

namespace penumbra::visibility {

TriangleBits::~TriangleBits() {
  for (const std::atomic<Page*>& page : pages_) delete page.load(std::memory_order_relaxed);
}

/// If two threads add the same page, the first one is kept.
TriangleBits::Page* TriangleBits::add_page(std::uint64_t number) {
  auto made = std::make_unique<Page>();
  Page* first = nullptr;
  return pages_[number].compare_exchange_strong(first, made.get(), std::memory_order_acq_rel) ? made.release() : first;
}

std::uint64_t TriangleBits::count() const {
  std::uint64_t count = 0;
  for (const std::atomic<Page*>& page : pages_) {
    const Page* const words = page.load(std::memory_order_relaxed);
    if (words == nullptr) continue;
    for (const std::atomic<std::uint64_t>& word : *words)
      count += static_cast<std::uint64_t>(std::popcount(word.load(std::memory_order_relaxed)));
  }
  return count;
}

}  // namespace penumbra::visibility
