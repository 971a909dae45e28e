// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::visibility {

/// A bit for each triangle of all parts of a scene. Memory is taken where bits are set, since a part of a picture needs
/// few triangles of a large scene. Several threads may set bits at once; the other functions may not run meanwhile.
class TriangleBits {
 public:
  explicit TriangleBits(std::uint64_t triangles) : pages_((triangles + kPage - 1) / kPage) {}
  ~TriangleBits();
  TriangleBits(const TriangleBits&) = delete;
  TriangleBits& operator=(const TriangleBits&) = delete;

  void set(std::uint64_t bit) {
    Page* page = pages_[bit / kPage].load(std::memory_order_acquire);
    if (page == nullptr) page = add_page(bit / kPage);
    std::atomic<std::uint64_t>& word = (*page)[bit % kPage / 64];
    const std::uint64_t mask = std::uint64_t{1} << bit % 64;
    if ((word.load(std::memory_order_relaxed) & mask) == 0) word.fetch_or(mask, std::memory_order_relaxed);
  }
  /// Returns the number of bits that are set.
  [[nodiscard]] std::uint64_t count() const;
  /// Calls take(bit) for each bit that is set, in [first, end), in ascending order.
  template <typename Take>
  void for_each(std::uint64_t first, std::uint64_t end, const Take& take) const;

 private:
  static constexpr std::uint64_t kPage = 4096;  // bits
  using Page = std::array<std::atomic<std::uint64_t>, kPage / 64>;

  Page* add_page(std::uint64_t number);

  std::vector<std::atomic<Page*>> pages_;  // null: no bit is set
};

template <typename Take>
void TriangleBits::for_each(std::uint64_t first, std::uint64_t end, const Take& take) const {
  for (std::uint64_t at = first; at < end; at = (at / kPage + 1) * kPage) {
    const Page* const page = pages_[at / kPage].load(std::memory_order_relaxed);
    if (page == nullptr) continue;
    for (std::uint64_t word = at % kPage / 64; word < page->size(); ++word) {
      const std::uint64_t lowest = at / kPage * kPage + word * 64;
      std::uint64_t bits = (*page)[word].load(std::memory_order_relaxed);
      for (; bits != 0; bits &= bits - 1) {
        const std::uint64_t bit = lowest + static_cast<std::uint64_t>(std::countr_zero(bits));
        if (bit >= end) return;
        if (bit >= first) take(bit);
      }
    }
  }
}

}  // namespace penumbra::visibility
