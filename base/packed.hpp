#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct z_stream_s;  // zlib's

namespace penumbra {

/// RFC 4648, with padding.
std::string base64(std::span<const std::byte> bytes);

/// Bytes deflated as they come (RFC 1950, what a browser's DecompressionStream calls "deflate"): of what is added in
/// parts no more than the result is kept. The same bytes give the same result, however they are parted.
class Deflated {
 public:
  Deflated();
  Deflated(Deflated&& other) noexcept;
  Deflated& operator=(Deflated&& other) noexcept;
  ~Deflated();

  void add(std::span<const std::byte> bytes);
  /// All that was added. Last of all calls.
  std::vector<std::byte> finish();

 private:
  void run(std::span<const std::byte> bytes, int flush);

  std::unique_ptr<z_stream_s> stream_;
  std::vector<std::byte> result_;
};

}  // namespace penumbra
