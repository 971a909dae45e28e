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

/// A page's WebSocket, numbered from 1 in the order in which they were opened.
using ClientId = std::uint64_t;

/// What one client may ask of the server; whoever goes beyond is disconnected.
struct ServerLimits {
  std::size_t clients = 8;                         ///< sockets that are open at once
  std::size_t message_bytes = 1U << 16;            ///< of one message to the server
  double messages_per_second = 250;                ///< on average
  double burst = 500;                              ///< messages at once, after a pause
  std::size_t waiting_texts = 64;                  ///< messages that a client has not read yet
  std::chrono::milliseconds request_time{10'000};  ///< from a connection to the end of its request
  std::chrono::milliseconds silence{30'000};       ///< without an answer to a ping
};

/// A file that is made when it is asked for.
struct ServedFile {
  std::string path;                   ///< with a slash in front
  std::string type;                   ///< MIME
  std::string name;                   ///< under which a browser saves it
  std::function<std::string()> make;  ///< on a thread of its own; what it throws is an answer 500 with the message
};

struct ServerOptions {
  std::uint16_t port = 0;  ///< 0: any that is free
  std::string token;       ///< that each request must have: make_token()
  std::string page;        ///< HTML; @NONCE@ becomes the nonce of its script and style elements
  std::string socket_path = "/live";
  std::vector<ServedFile> files = {};
  ServerLimits limits = {};
};

/// Hears of clients, on the server's own thread.
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

/// Serves a page and its WebSocket on 127.0.0.1, by a thread of its own, until it is destroyed. A request without the
/// token, to another host name than the loopback's, or from another page's origin is answered 403, whatever it asks
/// for. Functions may be called on any thread.
class PageServer {
 public:
  /// `handler` must outlive it. Throws ResourceError if the port is taken.
  PageServer(ServerOptions options, PageHandler& handler);
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  ~PageServer();

  [[nodiscard]] std::uint16_t port() const;
  /// Where the page is, with the token.
  [[nodiscard]] std::string address() const;

  /// Ends the thread: the handler hears nothing more, and what is sent goes nowhere. Not on the server's own thread.
  void stop();
  /// Sends a message that must arrive.
  void send(ClientId client, std::string text);
  void send_to_all(std::string text);
  /// Sends a message to all clients but `except` (0: to all); one that a client has not been sent yet is replaced.
  void send_newest(std::string text, ClientId except = 0);
  /// The same with a binary message; a client gets the next when it has taken the last one.
  void send_frame(std::shared_ptr<const std::string> frame);
  /// The client has shown what it got.
  void taken(ClientId client);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::network
