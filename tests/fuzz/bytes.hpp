// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

/// Entry point for libFuzzer, and in other builds for the replay of the corpus (replay_main.cpp).
extern "C" int LLVMFuzzerTestOneInput(  // NOLINT(readability-identifier-naming): libFuzzer's name
    const std::uint8_t* data, std::size_t size);

namespace penumbra::fuzz {

/// Takes values from a fuzzer's input, and zeros after its end.
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
