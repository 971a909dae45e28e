// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/device.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace penumbra::device {

/// A list that kernels append to: a head of counters, then items. Kernels continue counting beyond its capacity; the
/// list then grows, and the kernels run again: nothing is cut off, and no result of the failed run is used.
class GrowingList {
 public:
  struct Shape {
    std::string name;
    std::uint64_t head_bytes = 0, item_bytes = 0;
    std::uint32_t capacity = 0;  ///< initial capacity
  };
  GrowingList(const render::Device& device, Shape shape)
      : device_(&device), shape_(std::move(shape)), capacity_(shape_.capacity) {}

  [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
  void want(std::uint32_t items) { capacity_ = capacity_ < items ? items : capacity_; }
  /// Returns whether the list fits into a storage buffer.
  [[nodiscard]] bool is_possible() const { return bytes() <= device_->limits().max_storage_buffer_range; }
  void shrink() { capacity_ = shape_.capacity; }  ///< resets to the initial capacity
  void set_item_bytes(std::uint64_t bytes) {
    shape_.item_bytes = bytes;
    if (!is_possible()) shrink();
  }

  /// Records the clearing of the list: makes its buffer large enough and sets its head to 0.
  void clear(render::Commands& commands) {
    render::grow(*device_, buffer_, shape_.name, bytes());
    commands.fill(*buffer_, 0, 0, shape_.head_bytes);
  }
  [[nodiscard]] const render::Buffer& buffer() const { return *buffer_; }
  template <typename Head>
  [[nodiscard]] Head head() const {
    Head head;
    buffer_->read(std::span(&head, 1));
    return head;
  }
  template <typename Item>
  void read(std::span<Item> items) const {
    buffer_->read(items, shape_.head_bytes);
  }

  /// Returns whether the list has space for `items` items; if not, grows it.
  [[nodiscard]] bool holds(std::uint32_t items) {
    if (items <= capacity_) return true;
    capacity_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{items} + items / 8, ~0U));
    return false;
  }

 private:
  [[nodiscard]] std::uint64_t bytes() const { return shape_.head_bytes + capacity_ * shape_.item_bytes; }

  const render::Device* device_;
  Shape shape_;
  std::uint32_t capacity_;
  std::unique_ptr<render::Buffer> buffer_;
};

}  // namespace penumbra::device
