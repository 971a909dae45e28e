// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/ply_header.hpp"
#include "import/text.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {

/// The numbers of a binary body, taken from its front: one by one, or in bulk for elements of usual layouts.
class BinaryNumbers {
 public:
  BinaryNumbers(const PlyHeader& header, const std::string& file)
      : bytes_(header.body), size_(header.body.size()), file_(file), swap_(header.format == PlyFormat::big_endian) {}

  double number(PlyType type);
  void end_element() {}
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size(); }
  [[nodiscard]] bool has_more() const { return !bytes_.empty(); }
  static std::uint64_t lines_with_more() { return 0; }
  static std::size_t least_size(PlyType type) { return size_of(type); }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: byte {} after the header: {}", file_, size_ - bytes_.size(),
                     text_for_people(format, std::forward<Args>(args)...));
  }

  /// Takes up to `most` vertices whose coordinates are the properties number `axes`, in bulk; returns the number taken.
  /// Takes none if a property is a list or the coordinates' types differ; stops at a vertex that is incomplete, or not
  /// finite, which number() must handle.
  std::uint64_t take_vertices(const PlyElement& element, std::array<std::size_t, 3> axes, std::uint64_t most,
                              std::vector<glm::dvec3>& positions);

  /// Takes faces in bulk, calling keep(corners) for each. Takes none if another property is a list or the corners are
  /// not 32-bit integers; stops at a face that is incomplete, has more than 32 corners, or refers to a vertex from
  /// `vertices` on.
  template <typename Keep>
  std::uint64_t take_faces(const PlyElement& element, std::size_t corners, std::uint64_t most, std::uint64_t vertices,
                           const Keep& keep);

 private:
  template <typename Number>
  [[nodiscard]] static Number load(const char* from, bool swap) {
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), from, raw.size());
    if (swap) {
      for (std::size_t i = 0; i < raw.size() / 2; ++i) std::swap(raw[i], raw[raw.size() - 1 - i]);
    }
    return std::bit_cast<Number>(raw);
  }
  [[nodiscard]] static std::int64_t load_length(const char* from, PlyType type, bool swap);
  template <typename Number>
  Number take();
  template <typename Number>
  std::uint64_t take_places(std::array<std::size_t, 3> offsets, std::size_t stride, std::uint64_t most,
                            std::vector<glm::dvec3>& positions);

  std::string_view bytes_;
  std::size_t size_;
  const std::string& file_;
  bool swap_;
};

template <typename Keep>
std::uint64_t BinaryNumbers::take_faces(const PlyElement& element, std::size_t corners, std::uint64_t most,
                                        std::uint64_t vertices, const Keep& keep) {
  const PlyProperty& list = element.properties[corners];
  if (list.type != PlyType::int32 && list.type != PlyType::uint32) return 0;
  std::size_t before = 0, after = 0;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (i == corners) continue;
    if (element.properties[i].is_list) return 0;
    (i < corners ? before : after) += size_of(element.properties[i].type);
  }
  const bool has_sign = list.type == PlyType::int32;
  const std::size_t head = before + size_of(list.length_type);
  std::array<std::uint32_t, 32> named{};
  const char *at = bytes_.data(), *const end = at + bytes_.size();
  std::uint64_t taken = 0;
  for (; taken < most; ++taken) {
    if (static_cast<std::size_t>(end - at) < head) break;
    const std::int64_t count = load_length(at + before, list.length_type, swap_);
    if (count < 0 || count > std::ssize(named)) break;
    const std::size_t size = head + static_cast<std::size_t>(count) * 4 + after;
    if (static_cast<std::size_t>(end - at) < size) break;
    bool known = true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      named[i] = load<std::uint32_t>(at + head + 4 * i, swap_);
      known &= named[i] < vertices && !(has_sign && named[i] > 0x7fffffffU);  // negative numbers are unknown
    }
    if (!known) break;
    keep(std::span<const std::uint32_t>(named).first(static_cast<std::size_t>(count)));
    at += size;
  }
  bytes_.remove_prefix(static_cast<std::size_t>(at - bytes_.data()));
  return taken;
}

}  // namespace penumbra::import
