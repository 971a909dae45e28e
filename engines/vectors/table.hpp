// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>
#include <utility>

/// Inside engines/vectors/ only, and in the stages of methods.
namespace penumbra::vectors {

/// Columns of floats, one after the other.
template <std::size_t kFields>
class Table {
 public:
  static constexpr std::size_t kSlack = 64;  ///< vectors may be written beyond the last row

  float* operator[](std::size_t field) { return data_.get() + field * capacity_; }
  const float* operator[](std::size_t field) const { return data_.get() + field * capacity_; }
  /// Pointers into a row, for code that writes many rows; valid until the next reserve().
  struct Row {
    float* first;
    std::size_t stride;

    float* operator[](std::size_t field) const { return first + field * stride; }
  };
  Row row(std::size_t number) { return {data_.get() + number, capacity_}; }
  void reserve(std::size_t rows) {
    if (rows + kSlack <= capacity_) return;
    const std::size_t capacity = (2 * rows + 2 * kSlack + 15) / 16 * 16 + 16;  // + 16: columns begin in different sets
                                                                               // of the cache
    auto data = hwy::AllocateAligned<float>(kFields * capacity);
    for (std::size_t field = 0; field < kFields && capacity_ > 0; ++field) {
      std::copy_n((*this)[field], count, data.get() + field * capacity);
    }
    std::fill_n(data.get(), capacity_ == 0 ? kFields * capacity : 0, 0.0F);
    data_ = std::move(data);
    capacity_ = capacity;
  }

  std::size_t count = 0;

 private:
  hwy::AlignedFreeUniquePtr<float[]> data_;
  std::size_t capacity_ = 0;
};

}  // namespace penumbra::vectors
