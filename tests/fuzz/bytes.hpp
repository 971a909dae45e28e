// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

/// Entry point for libFuzzer, and for the replay of the corpus in other builds (replay_main.cpp).
extern "C" int LLVMFuzzerTestOneInput(  // NOLINT(readability-identifier-naming): libFuzzer's name
    const std::uint8_t* data, std::size_t size);

namespace penumbra::fuzz {

/// Takes values off a fuzzer's input; zeros once it has run out.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> data) : data_(data) {}

  [[nodiscard]] bool empty() const { return data_.empty(); }

  template <typename Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(sizeof(Value), data_.size());
    std::memcpy(&value, data_.data(), count);
    data_ = data_.subspan(count);
    return value;
  }

 private:
  std::span<const std::uint8_t> data_;
};

}  // namespace penumbra::fuzz
