#pragma once

#include <array>
#include <cstddef>
#include <mutex>

namespace penumbra {

/// Large arrays that were given back, kept for the next of about their size: the C library would give them to the
/// system, which then clears each page anew. Those in use and those kept are together never more than what was in use
/// at once, so that no picture takes more memory for it. Of all threads.
class KeptArrays {
 public:
  /// What is smaller the C library keeps itself (keep_freed_memory).
  static constexpr std::size_t kLeast = std::size_t{1} << 25U;

  /// Before this none is.
  void start_keeping();
  /// Null: none is as large, or all are larger by more than an eighth; and the caller will ask for a new one, for which
  /// there is room then.
  [[nodiscard]] void* take(std::size_t bytes);
  /// A new one is in use.
  void count(std::size_t bytes);
  /// One is no longer in use. False: it is not kept.
  [[nodiscard]] bool keep(void* first, std::size_t bytes);
  /// Gives all of them back to the C library.
  void free_all();
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Array {
    void* first = nullptr;
    std::size_t bytes = 0;
  };

  void begin_use(std::size_t bytes);
  void free_more_than(std::size_t room);

  mutable std::mutex mutex_;
  std::array<Array, 64> kept_{};  // in any order
  bool keeps_ = false;
  std::size_t kept_bytes_ = 0, used_bytes_ = 0, most_used_bytes_ = 0;
};

/// Those of `operator new` (pages.cpp).
KeptArrays& kept_arrays();

}  // namespace penumbra
