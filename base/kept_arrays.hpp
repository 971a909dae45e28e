#pragma once

#include <array>
#include <cstddef>
#include <mutex>

namespace penumbra {

/// Large arrays that were given back, kept for the next of about their size: the C library would give them to the
/// system, which then clears each page anew. Large arrays that are in use and those that are kept are together never
/// more than the most that was in use at once. Any thread may call any of these.
class KeptArrays {
 public:
  /// Bytes; smaller arrays the C library keeps itself (keep_freed_memory).
  static constexpr std::size_t kLeast = std::size_t{1} << 25U;

  /// Nothing is kept before this is called.
  void start_keeping();
  /// An array of at least so many bytes, at most an eighth more: the smallest that is kept. Null: there is none, and
  /// the caller makes one and says so (settle); others are freed if they would be too much beside it.
  [[nodiscard]] void* take(std::size_t bytes);
  /// What was asked for and not there is an array of so many bytes now; 0: none that will be given to keep().
  void settle(std::size_t bytes, std::size_t made);
  /// An array is no longer in use. False: it is not kept, and the caller's to free.
  [[nodiscard]] bool keep(void* first, std::size_t bytes);
  void free_all();
  /// Of all that are kept.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Array {
    void* first = nullptr;
    std::size_t bytes = 0;
  };

  void use(std::size_t bytes);
  void free_more_than(std::size_t room);

  mutable std::mutex mutex_;
  std::array<Array, 64> kept_{};  // in any order
  bool keeps_ = false;
  std::size_t kept_bytes_ = 0, used_bytes_ = 0, most_used_bytes_ = 0;
};

/// Those of `operator new` (pages.cpp).
KeptArrays& kept_arrays();

}  // namespace penumbra
