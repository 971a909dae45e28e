// SPDX-License-Identifier: Apache-2.0
// Sends pictures to tev by its network protocol.

#include "network/tev_client.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>

namespace penumbra::network {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr std::chrono::seconds kConnect{5}, kSend{30};

enum class Packet : std::uint8_t { create_image = 4, update_image = 6 };

/// Writes values one after the other, preceded by the total length.
class PacketText {
 public:
  explicit PacketText(Packet type) {
    number(std::uint32_t{0});  // the length, set at the end
    number(static_cast<std::uint8_t>(type));
  }
  template <typename Number>
  void number(Number value) {
    static_assert(std::endian::native == std::endian::little, "tev reads little-endian numbers");
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));
    text_.append(bytes, sizeof(Number));
  }
  void text(std::string_view value) {
    text_ += value.substr(0, value.find('\0'));
    text_ += '\0';
  }
  void values(std::span<const float> values) {
    text_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  std::string take() {
    const auto length = static_cast<std::uint32_t>(text_.size());
    std::memcpy(text_.data(), &length, sizeof(length));
    return std::move(text_);
  }

 private:
  std::string text_;
};

std::string create_image(const TevPicture& picture) {
  PacketText packet(Packet::create_image);
  packet.number(std::uint8_t{1});  // grabs the focus
  packet.text(picture.name);
  packet.number(static_cast<std::int32_t>(picture.width));
  packet.number(static_cast<std::int32_t>(picture.height));
  packet.number(static_cast<std::int32_t>(picture.channels.size()));
  for (const TevChannel& channel : picture.channels) packet.text(channel.name);
  return packet.take();
}

std::string update_image(const TevPicture& picture, std::uint32_t row, std::uint32_t rows) {
  PacketText packet(Packet::update_image);
  packet.number(std::uint8_t{0});
  packet.text(picture.name);
  packet.number(static_cast<std::int32_t>(picture.channels.size()));
  for (const TevChannel& channel : picture.channels) packet.text(channel.name);
  for (const std::uint32_t value : {0U, row, picture.width, rows}) packet.number(static_cast<std::int32_t>(value));
  const std::size_t first = std::size_t{row} * picture.width, count = std::size_t{rows} * picture.width;
  // Offset of each channel in the following floats, and the stride of its values.
  for (std::size_t i = 0; i < picture.channels.size(); ++i) packet.number(static_cast<std::int64_t>(i * count));
  for (std::size_t i = 0; i < picture.channels.size(); ++i) packet.number(std::int64_t{1});
  for (const TevChannel& channel : picture.channels) packet.values(channel.values.subspan(first, count));
  return packet.take();
}

}  // namespace

std::vector<std::string> tev_packets(const TevPicture& picture) {
  for (const TevChannel& channel : picture.channels) {
    PENUMBRA_ASSERT(channel.values.size() == std::size_t{picture.width} * picture.height, "channel {} has {} values",
                    channel.name, channel.values.size());
  }
  std::vector<std::string> packets = {create_image(picture)};
  constexpr std::size_t kMost = std::size_t{1} << 20;  // values of a packet
  const std::size_t row_values = std::max<std::size_t>(std::size_t{picture.width} * picture.channels.size(), 1);
  const auto rows = static_cast<std::uint32_t>(std::max<std::size_t>(kMost / row_values, 1));
  for (std::uint32_t row = 0; row < picture.height; row += rows)
    packets.push_back(update_image(picture, row, std::min(rows, picture.height - row)));
  return packets;
}

std::pair<std::string, std::string> split_tev_address(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  std::string host = address.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const bool is_number = !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (host.empty() || !is_number || std::stoul(port) == 0 || std::stoul(port) > 65535)
    throw UsageError("--tev {}: expected HOST:PORT, such as 127.0.0.1:14158", address);
  return {host, port};
}

class TevClient::Connection {
 public:
  explicit Connection(const std::string& address) : address_(address) {
    const auto [host, port] = split_tev_address(address);
    tcp::resolver resolver(io_);
    Error error;
    const auto endpoints = resolver.resolve(host, port, error);
    if (error) throw ResourceError("--tev {}: {}", address, error.message());
    asio::async_connect(socket_, endpoints, [this](const Error& found, const tcp::endpoint&) { done(found); });
    if (const std::string why = wait(kConnect); !why.empty())
      throw ResourceError("--tev {}: no tev answers there ({}); start it first", address, why);
  }

  void send(const std::string& packet) {
    asio::async_write(socket_, asio::buffer(packet), [this](const Error& found, std::size_t) { done(found); });
    if (const std::string why = wait(kSend); !why.empty())
      throw ResourceError("--tev {}: tev no longer accepts pictures ({})", address_, why);
  }

 private:
  void done(const Error& error) {
    error_ = error;
    is_done_ = true;
  }
  /// Waits for the pending operation and returns the reason of its failure; empty: success.
  std::string wait(std::chrono::seconds most) {
    is_done_ = false;
    io_.restart();
    io_.run_for(most);
    if (!is_done_) {
      socket_.close();
      io_.run();  // ends the operation
      return "it does not answer";
    }
    return error_ ? error_.message() : "";
  }

  std::string address_;
  asio::io_context io_{1};
  tcp::socket socket_{io_};
  Error error_;
  bool is_done_ = false;
};

TevClient::TevClient(const std::string& address) : connection_(std::make_unique<Connection>(address)) {}
TevClient::~TevClient() = default;

void TevClient::show(const TevPicture& picture) {
  for (const std::string& packet : tev_packets(picture)) connection_->send(packet);
}

}  // namespace penumbra::network
