// SPDX-License-Identifier: Apache-2.0
// Converts the channels of an OpenEXR file to the bytes of its scan lines.

#include "base/exr_planes.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <variant>

namespace penumbra::exr {
namespace {

constexpr float kLargestHalf = 65504;
/// Smallest float that rounds to infinity in 16 bits.
constexpr float kPastHalf = 65520;

}  // namespace

Plane::Plane(const ExrChannel& channel, std::size_t pixel_count) {
  std::visit(
      [&](const auto& values) {
        using Values = std::remove_cvref_t<decltype(values)>;
        if constexpr (std::is_same_v<Values, ExrValues>) {
          values_ = &values;
        } else {
          PENUMBRA_ASSERT(values.size() > (pixel_count - 1) * channel.stride,
                          "channel {}: {} values for {} pixels with stride {}", channel.name, values.size(),
                          pixel_count, channel.stride);
          first_ = reinterpret_cast<const std::byte*>(values.data());
          stride_ = channel.stride * sizeof(values[0]);
          if constexpr (!std::is_same_v<typename Values::element_type, const float>) type_ = Type::uint32;
        }
      },
      channel.values);
  if (!channel.half) return;
  PENUMBRA_ASSERT(type_ == Type::float32, "channel {} has integers, not to be rounded", channel.name);
  type_ = Type::float16;
}

void Plane::gather_words(std::size_t pixel, std::size_t width, std::byte* to, std::vector<float>& scratch) const {
  static_assert(std::endian::native == std::endian::little, "OpenEXR's order of bytes");
  if (values_ != nullptr) {
    scratch.resize(width);
    (*values_)(pixel, scratch);
    std::memcpy(to, scratch.data(), 4 * width);
    return;
  }
  const std::byte* from = first_ + pixel * stride_;
  if (stride_ == 4) {
    std::memcpy(to, from, 4 * width);
    return;
  }
  for (std::size_t x = 0; x < width; ++x) std::memcpy(to + 4 * x, from + x * stride_, 4);
}

void Plane::gather(std::size_t pixel, std::size_t width, std::uint8_t* to, std::vector<float>& scratch,
                   std::atomic<std::uint64_t>& too_large) const {
  if (type_ != Type::float16 && !bounded_) {
    gather_words(pixel, width, reinterpret_cast<std::byte*>(to), scratch);
    return;
  }
  std::vector<float> values(width);
  gather_words(pixel, width, reinterpret_cast<std::byte*>(values.data()), scratch);
  std::uint64_t count = 0;
  for (std::size_t x = 0; x < width; ++x) {
    float& value = values[x];
    if (std::isfinite(value) && std::abs(value) >= kPastHalf) {
      value = std::copysign(kLargestHalf, value);
      ++count;
    }
    if (type_ == Type::float16) {
      const std::uint16_t bits = half(value).bits();
      std::memcpy(to + 2 * x, &bits, 2);
    }
  }
  if (type_ == Type::float32) std::memcpy(to, values.data(), 4 * width);
  if (count != 0) too_large += count;
}

void check_name(const std::filesystem::path& path, const char* what, const std::string& name) {
  constexpr std::size_t kLongestName = 255;  // of an OpenEXR 2.0 file with long names
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) {
    throw InputError(
        "cannot write \"{}\": an OpenEXR {} has 1 to {} bytes and no zero byte, but \"{}\" has {}; use a shorter name",
        path.string(), what, kLongestName, name.c_str(), name.size());
  }
}

}  // namespace penumbra::exr
