// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/assert.hpp"
#include "base/kept_arrays.hpp"
#include "base/pages.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace penumbra::vectors {

/// The leaves of a hierarchy, and those of appended hierarchies. Few of millions of leaves are between any view sample
/// and a light: large sets of leaves are made on demand.
template <typename Leaf>
class WideLeaves {
 public:
  /// Fills a leaf, which is initialised to Leaf{}. Called on any thread, as long as leaves are missing.
  using Make = std::function<void(std::size_t number, Leaf& leaf)>;

  WideLeaves() = default;
  WideLeaves(const WideLeaves&) = default;
  /// The moved-from object is empty.
  WideLeaves(WideLeaves&& other) noexcept { *this = std::move(other); }
  WideLeaves& operator=(const WideLeaves& other) {
    *this = WideLeaves(other);
    return *this;
  }
  WideLeaves& operator=(WideLeaves&& other) noexcept {
    count_ = std::exchange(other.count_, 0);
    own_ = std::move(other.own_);
    make_ = std::move(other.make_);
    blocks_ = std::move(other.blocks_);
    held_bytes_ = std::exchange(other.held_bytes_, 0);
    appended_ = std::move(other.appended_);
    return *this;
  }
  ~WideLeaves() = default;

  /// Makes all leaves: immediately if they are few, else in blocks on demand. `held`: bytes that `make` holds.
  void make(std::size_t count, Make make, std::uint64_t held = 0) {
    constexpr std::size_t kFew = std::size_t{1} << 16U;
    count_ = count;
    if (count > kFew) {
      own_ = UnsetList<Leaf>();
      make_ = std::move(make);
      held_bytes_ = held;
      blocks_ = Blocks((count + kBlock - 1) / kBlock);
      return;
    }
    make_now(count, make);
  }
  void make_now(std::size_t count, const Make& make) {
    count_ = count;
    make_ = {};
    blocks_ = {};
    held_bytes_ = 0;
    own_.resize(count);
    make_again([](std::size_t) { return true; }, make);
  }
  /// Makes the wanted leaves again, in place; all must have been made at once.
  template <typename Wanted>
  void make_again(const Wanted& wanted, const Make& make) {
    PENUMBRA_ASSERT(blocks_.empty(), "{} leaves are made at first use", count_);
    for_each_index(own_.size(), [&](std::size_t number) {
      if (wanted(number)) make(number, own_[number] = {});
    });
  }

  [[nodiscard]] std::size_t size() const { return count_ + appended_.size(); }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] const Leaf& operator[](std::size_t number) const {
    if (number >= count_) return appended_[number - count_];
    if (blocks_.empty()) return own_[number];
    const Leaf* const block = blocks_.made(number / kBlock);
    return (block != nullptr ? block : make_block(number / kBlock))[number % kBlock];
  }
  /// Prefetches a leaf if it is made already.
  void fetch(std::size_t number) const {
    const Leaf* leaf = nullptr;
    if (number >= count_) return;
    if (blocks_.empty()) {
      leaf = &own_[number];
    } else {
      leaf = blocks_.made(number / kBlock);
      if (leaf == nullptr) return;
      leaf += number % kBlock;
    }
    const auto* const lines = reinterpret_cast<const std::byte*>(leaf);
    for (std::size_t line = 0; line < sizeof(Leaf); line += 64) __builtin_prefetch(lines + line);
  }
  [[nodiscard]] Leaf& operator[](std::size_t number) { return const_cast<Leaf&>(std::as_const(*this)[number]); }

  void append(const WideLeaves& more) {
    for (std::size_t i = 0; i < more.size(); ++i) appended_.push_back(more[i]);
  }
  void forget_appended() { appended_.clear(); }

  /// Returns the bytes of the made leaves, and of the data from which the others are made.
  [[nodiscard]] std::uint64_t memory_bytes() const {
    return (own_.size() + appended_.size()) * sizeof(Leaf) + blocks_.memory_bytes() + held_bytes_;
  }

 private:
  static constexpr std::size_t kBlock = 16;  // leaves that are made together: about ten kilobytes

  /// Blocks of leaves made on demand. Thread-safe.
  class Blocks {
   public:
    Blocks() = default;
    explicit Blocks(std::size_t count) : firsts_(std::make_unique<std::atomic<Leaf*>[]>(count)), count_(count) {}
    Blocks(const Blocks& other) : Blocks(other.count_) {
      for (std::size_t i = 0; i < count_; ++i) {
        const Leaf* const made = other.made(i);
        if (made != nullptr) std::copy_n(made, kBlock, firsts_[i] = unset_block());
      }
    }
    Blocks(Blocks&& other) noexcept
        : firsts_(std::move(other.firsts_)),
          count_(std::exchange(other.count_, 0)),
          slabs_(std::move(other.slabs_)),
          taken_(other.taken_) {}
    Blocks& operator=(Blocks other) noexcept {
      firsts_ = std::move(other.firsts_);
      count_ = std::exchange(other.count_, 0);
      slabs_ = std::move(other.slabs_);
      taken_ = other.taken_;
      return *this;
    }
    ~Blocks() = default;

    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] Leaf* made(std::size_t block) const { return firsts_[block].load(std::memory_order_acquire); }
    /// Returns memory for one block.
    [[nodiscard]] Leaf* unset_block() {
      const std::scoped_lock lock(mutex_);
      if (slabs_.empty() || taken_ == kSlab) {
        slabs_.emplace_back(kSlab * kBlock);
        taken_ = 0;
      }
      return &slabs_.back()[kBlock * taken_++];
    }
    /// Returns the stored block: if two threads add the same block, the first one is kept.
    const Leaf* add(std::size_t block, Leaf* leaves) {
      Leaf* first = nullptr;
      return firsts_[block].compare_exchange_strong(first, leaves) ? leaves : first;
    }
    [[nodiscard]] std::uint64_t memory_bytes() const {
      const std::size_t blocks = slabs_.empty() ? 0 : (slabs_.size() - 1) * kSlab + taken_;
      return count_ * sizeof(firsts_[0]) + blocks * kBlock * sizeof(Leaf);
    }

   private:
    /// Number of blocks in one array. Arrays are cached for those of the next frame, since the system provides memory
    /// slowly.
    static constexpr std::size_t kSlab = (KeptArrays::kLeast - 1) / (kBlock * sizeof(Leaf)) + 1;

    std::unique_ptr<std::atomic<Leaf*>[]> firsts_;  // for each block its leaves, or null
    std::size_t count_ = 0;
    std::vector<UnsetList<Leaf>> slabs_;
    std::size_t taken_ = 0;  // used blocks of the last slab
    std::mutex mutex_;
  };

  [[nodiscard]] [[gnu::noinline]] const Leaf* make_block(std::size_t block) const {
    Leaf* const leaves = blocks_.unset_block();
    for (std::size_t i = 0; i < kBlock; ++i) {
      leaves[i] = {};
      if (const std::size_t number = block * kBlock + i; number < count_) make_(number, leaves[i]);
    }
    return blocks_.add(block, leaves);
  }

  std::size_t count_ = 0;
  UnsetList<Leaf> own_;  // if they were made at once
  Make make_;            // if they are made on demand
  mutable Blocks blocks_;
  std::uint64_t held_bytes_ = 0;
  std::vector<Leaf> appended_;
};

}  // namespace penumbra::vectors
