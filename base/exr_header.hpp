// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/exr.hpp"
#include "base/exr_planes.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace penumbra {

/// Collects the bytes of an OpenEXR header: little-endian numbers, and text that ends with a zero byte.
class ExrBytes {
 public:
  template <typename Number>
  void put(const Number& number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    const auto* first = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), first, first + sizeof number);
  }
  void put_text(std::string_view text) {
    put_characters(text);
    put('\0');
  }
  void put_characters(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    bytes_.insert(bytes_.end(), first, first + text.size());
  }
  [[nodiscard]] std::span<const std::byte> all() const& { return bytes_; }
  std::span<const std::byte> all() const&& = delete;
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Returns the beginning of an OpenEXR file of one part with scan lines, with any compression but DWAA, up to the table
/// of its blocks. `types` gives the type of each channel by name. Takes time linear in the number of channels, which is
/// large for scenes with many lights: OpenEXR's library (3.1) searches all channels for each that is added.
std::vector<std::byte> exr_header(const ExrImage& image, const std::map<std::string, exr::Type>& types);

}  // namespace penumbra
