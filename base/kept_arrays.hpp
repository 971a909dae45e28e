// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <mutex>

namespace penumbra {

/// Cache of large freed arrays for reuse by allocations of about the same size: the C library would return such memory
/// to the system, which then clears each page again. The arrays in use and the cached ones together never exceed the
/// most that was in use at once. Thread-safe.
class KeptArrays {
 public:
  /// Bytes of the smallest array that is cached; the C library keeps smaller ones itself (keep_freed_memory).
  static constexpr std::size_t kLeast = std::size_t{1} << 22U;

  /// Enables the cache; nothing is cached before this call.
  void start_keeping();
  /// Returns the smallest cached array of at least `bytes` bytes and at most half as many more. Returns null if there
  /// is none: the caller then allocates an array and calls settle(); cached arrays that would exceed the limit together
  /// with the new one are freed.
  [[nodiscard]] void* take(std::size_t bytes);
  /// Call after a take() that returned null: reports the size really allocated (0 if the array will never be given
  /// back).
  void settle(std::size_t bytes, std::size_t made);
  /// Takes an array that is no longer in use. Returns false if it is not cached: the caller then frees it.
  [[nodiscard]] bool keep(void* first, std::size_t bytes);
  void free_all();
  /// Returns the total size of all cached arrays.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Array {
    void* first = nullptr;
    std::size_t bytes = 0;
  };

  void use(std::size_t bytes);
  void free_more_than(std::size_t room);

  mutable std::mutex mutex_;
  std::array<Array, 256> kept_{};  // in no particular order
  bool keeps_ = false;
  std::size_t kept_bytes_ = 0, used_bytes_ = 0, most_used_bytes_ = 0;
};

/// Returns the cache that `operator new` uses (pages.cpp).
KeptArrays& kept_arrays();

}  // namespace penumbra
