// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::network {

/// Channel of a picture: a number for each pixel, row by row from the top.
struct TevChannel {
  std::string name;
  std::span<const float> values;
};

struct TevPicture {
  std::string name;
  std::uint32_t width = 0, height = 0;
  std::vector<TevChannel> channels;
};

/// Shows pictures in an open tev (https://github.com/Tom94/tev), by its protocol: packets of a 32-bit length, which
/// counts itself, a type and values, all little-endian; texts end with a zero byte.
class TevClient {
 public:
  /// Connects to tev. `address`: HOST:PORT; tev listens on 127.0.0.1:14158 by default. Throws UsageError for an invalid
  /// address, ResourceError if the connection is refused.
  explicit TevClient(const std::string& address);
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;
  ~TevClient();

  /// Shows a picture; replaces one of the same name. Throws ResourceError if tev accepts nothing for half a minute.
  void show(const TevPicture& picture);

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

/// Returns the packets that show a picture, in order: CreateImage, then UpdateImage (its third version) for stripes of
/// rows.
std::vector<std::string> tev_packets(const TevPicture& picture);

/// Splits HOST:PORT. Throws UsageError for anything else.
std::pair<std::string, std::string> split_tev_address(const std::string& address);

}  // namespace penumbra::network
