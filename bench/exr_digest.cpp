// SPDX-License-Identifier: Apache-2.0
// exr_digest FILE…: prints one line for each file, a digest of its size and of all its channels. Header attributes are
// left out, so that two builds with different names and the same picture agree. Used by bench/digests.sh.
#include "base/error.hpp"
#include "base/exr.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <string_view>

namespace {

/// FNV-1a, 64 bits: sufficient to detect accidental differences, not deliberate ones.
class Digest {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) state_ = (state_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::uint64_t digest_of(const char* path) {
  const penumbra::ExrFile file = penumbra::read_exr(path);
  Digest digest;
  digest.add(fmt::format("{}x{}", file.width, file.height));
  const auto add_channels = [&digest](const auto& channels) {
    for (const auto& [name, values] : channels) {
      digest.add(name);
      digest.add(std::as_bytes(std::span(values)));
    }
  };
  add_channels(file.floats);
  add_channels(file.integers);
  return digest.value();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (const char* path : std::span(argv, static_cast<std::size_t>(argc)).subspan(1))
      fmt::print("{:016x} {}\n", digest_of(path), path);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "exr_digest: %s\n", error.what());
    return 3;
  }
}
