// SPDX-License-Identifier: Apache-2.0
// Base64, and deflate in parts, for data embedded in HTML.

#include "base/packed.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

namespace penumbra {

std::string base64(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;  // 24 bits; missing bytes at the end are zero
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Deflated::Deflated() : stream_(std::make_unique<z_stream_s>()) {
  if (deflateInit(stream_.get(), Z_DEFAULT_COMPRESSION) != Z_OK) throw ResourceError("no memory to deflate in");
}

Deflated::Deflated(Deflated&& other) noexcept = default;

Deflated& Deflated::operator=(Deflated&& other) noexcept {
  std::swap(stream_, other.stream_);
  std::swap(result_, other.result_);
  return *this;
}

Deflated::~Deflated() {
  if (stream_) deflateEnd(stream_.get());
}

void Deflated::add(std::span<const std::byte> bytes) {
  // zlib's counters have 32 bits.
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kMost, bytes.size())))
    run(bytes.first(std::min(kMost, bytes.size())), Z_NO_FLUSH);
}

std::vector<std::byte> Deflated::finish() {
  run({}, Z_FINISH);
  return std::move(result_);
}

void Deflated::run(std::span<const std::byte> bytes, int flush) {
  std::array<Bytef, 1 << 14> part{};
  // zlib's interface predates const; it does not write here.
  stream_->next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream_->avail_in = static_cast<uInt>(bytes.size());
  do {
    stream_->next_out = part.data();
    stream_->avail_out = static_cast<uInt>(part.size());
    const int outcome = deflate(stream_.get(), flush);
    PENUMBRA_ASSERT(outcome == Z_OK || outcome == Z_STREAM_END || outcome == Z_BUF_ERROR, "deflate says {}", outcome);
    const auto* first = reinterpret_cast<const std::byte*>(part.data());
    result_.insert(result_.end(), first, first + (part.size() - stream_->avail_out));
  } while (stream_->avail_out == 0);
}

}  // namespace penumbra
