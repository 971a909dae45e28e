// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct z_stream_s;  // zlib's stream

namespace penumbra {

/// Encodes bytes in base64 (RFC 4648), with padding.
std::string base64(std::span<const std::byte> bytes);

/// Compresses bytes as they arrive (zlib format, RFC 1950, which a browser's DecompressionStream calls "deflate"): of
/// added parts only the compressed bytes are kept. Equal bytes give equal results, however they are divided into parts.
class Deflated {
 public:
  Deflated();
  Deflated(Deflated&& other) noexcept;
  Deflated& operator=(Deflated&& other) noexcept;
  ~Deflated();

  void add(std::span<const std::byte> bytes);
  /// Returns the compressed bytes of everything that was added. Must be the last call.
  std::vector<std::byte> finish();

 private:
  void run(std::span<const std::byte> bytes, int flush);

  std::unique_ptr<z_stream_s> stream_;
  std::vector<std::byte> result_;
};

}  // namespace penumbra
