// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::network {

/// Index of a page's WebSocket, from 1 in the order of opening.
using ClientId = std::uint64_t;

/// Limits of one client's use of the server; a client that exceeds a limit is disconnected.
struct ServerLimits {
  std::size_t clients = 8;                         ///< open sockets at once
  std::size_t message_bytes = 1U << 16;            ///< size of one message to the server
  double messages_per_second = 250;                ///< on average
  double burst = 500;                              ///< messages at once, after a pause
  std::size_t waiting_texts = 64;                  ///< messages not yet read by a client
  std::chrono::milliseconds request_time{10'000};  ///< from a connection to the end of its request
  std::chrono::milliseconds silence{30'000};       ///< without an answer to a ping
};

/// File made on request.
struct ServedFile {
  std::string path;  ///< beginning with a slash
  std::string type;  ///< MIME
  std::string name;  ///< default name when a browser saves the file; empty: a part of the page
  /// Makes the content from the request's target (parameter_of()). Runs on a separate thread, one request after the
  /// other. UsageError and InputError become a response 400 with the message, other exceptions a response 500.
  std::function<std::string(std::string_view target)> make;
};

/// Address on which a server listens.
struct ServerPlace {
  std::string host = "127.0.0.1";  ///< an address of this machine; requests must name it or the loopback
  std::uint16_t port = 0;          ///< 0: any free port
};

struct ServerOptions {
  ServerPlace place = {};
  std::string token;  ///< token that each request must carry: make_token()
  std::string page;   ///< HTML; @NONCE@ becomes the nonce of its script and style elements
  std::string socket_path = "/live";
  std::vector<ServedFile> files = {};
  ServerLimits limits = {};
};

/// Receives events of clients, on the server's own thread.
class PageHandler {
 public:
  PageHandler() = default;
  PageHandler(const PageHandler&) = delete;
  PageHandler& operator=(const PageHandler&) = delete;
  virtual ~PageHandler() = default;

  virtual void opened(ClientId client) = 0;
  virtual void message(ClientId client, std::string_view text) = 0;
  virtual void closed(ClientId client) = 0;
};

/// Serves a page and its WebSocket on a separate thread until it is destroyed. A request is answered with 403, whatever
/// its target, if it has no token, names a host other than the place's or the loopback, or comes from another page's
/// origin. Thread-safe.
class PageServer {
 public:
  /// Starts the server. `handler` must outlive this object. Throws UsageError for a host that is not a single address,
  /// ResourceError if the port is taken or the address is not this machine's.
  PageServer(ServerOptions options, PageHandler& handler);
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  ~PageServer();

  [[nodiscard]] std::uint16_t port() const;
  /// Returns the address of the page, with the token.
  [[nodiscard]] std::string address() const;

  /// Ends the thread: the handler receives nothing more, and messages are dropped. Not callable on the server's own
  /// thread.
  void stop();
  /// Sends a message that must arrive.
  void send(ClientId client, std::string text);
  void send_to_all(std::string text);
  /// Sends a message to all clients but `except` (0: to all); replaces a previous message not yet sent to a client.
  void send_newest(std::string text, ClientId except = 0);
  /// Sends a binary message to all clients in the same manner; a client gets the next one only after taken() was called
  /// for its previous one.
  void send_frame(std::shared_ptr<const std::string> frame);
  /// Records that the client has shown its most recent frame.
  void taken(ClientId client);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::network
