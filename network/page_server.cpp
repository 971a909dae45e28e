// SPDX-License-Identifier: Apache-2.0
// HTTP and WebSocket server by Boost.Beast, asynchronous on one thread, which runs all code below except
// ServedFile::make(). Connections own themselves (shared_ptr) while one of their operations is pending, as usual with
// Asio.
#include "network/page_server.hpp"

#include "base/error.hpp"
#include "network/requests.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <thread>
#include <utility>

namespace penumbra::network {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kHeaderBytes = 8192;
/// Time that a client has to answer when its connection is closed.
constexpr std::chrono::seconds kGoodbye{5};

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

Response respond(const Request& request, http::status status, const std::string& type, std::string body) {
  Response response(status, request.version());
  response.set(http::field::server, "penumbra");
  response.set(http::field::content_type, type);
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.keep_alive(false);
  const bool head = request.method() == http::verb::head;
  const std::size_t size = body.size();
  if (!head) response.body() = std::move(body);
  response.prepare_payload();
  if (head) response.content_length(size);
  return response;
}

Response say(const Request& request, http::status status, const std::string& text) {
  return respond(request, status, "text/plain; charset=utf-8", text + "\n");
}

}  // namespace

class PageServer::State {
 public:
  State(ServerOptions options, PageHandler& handler);
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { stop(); }

  void stop() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    makers_.join();
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const ServerOptions& options() const { return options_; }
  /// Returns the address as it appears in a URL.
  [[nodiscard]] const std::string& shown_host() const { return shown_host_; }
  template <typename Function>
  void post(Function function) {
    asio::post(io_, std::move(function));
  }
  void send(ClientId client, std::string text);
  void send_to_all(const std::string& text);
  void send_newest(const std::string& text, ClientId except);
  void send_frame(const std::shared_ptr<const std::string>& frame);
  void taken(ClientId client);

 private:
  class Socket;
  class Connection;
  void accept();

  ServerOptions options_;
  PageHandler& handler_;
  std::string nonce_ = make_token();
  std::size_t connections_ = 0;  // number of connections that have not become sockets; connections still held by io_ in
                                 // its destructor decrement this counter
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  std::string shown_host_;
  std::uint16_t port_ = 0;
  ClientId last_client_ = 0;
  std::map<ClientId, std::shared_ptr<Socket>> sockets_;
  asio::thread_pool makers_{1};
  std::thread thread_;
};

/// WebSocket of one client.
class PageServer::State::Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(State& server, tcp::socket&& socket) : server_(server), stream_(std::move(socket)) {}

  void begin(const Request& request) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = server_.options_.limits.request_time;
    timeout.idle_timeout = server_.options_.limits.silence;
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    stream_.auto_fragment(false);
    stream_.read_message_max(server_.options_.limits.message_bytes);
    stream_.async_accept(request, [self = this->shared_from_this()](beast::error_code error) {
      if (!error) self->open();
    });
  }

  void send(std::string text) {
    if (closing_) return;
    if (texts_.size() >= server_.options_.limits.waiting_texts) return close(websocket::close_code::policy_error);
    texts_.push_back(std::move(text));
    is_greeted_ = true;
    write();
  }
  void send_newest(std::string text) {
    newest_ = std::move(text);
    write();
  }
  void send_frame(std::shared_ptr<const std::string> frame) {
    frame_ = std::move(frame);
    write();
  }
  void taken() {
    has_frame_ = false;
    write();
  }
  void drop() { beast::get_lowest_layer(stream_).close(); }

 private:
  void open() {
    if (server_.sockets_.size() >= server_.options_.limits.clients)
      return close(websocket::close_code::try_again_later);
    id_ = ++server_.last_client_;
    server_.sockets_.emplace(id_, this->shared_from_this());
    server_.handler_.opened(id_);
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = this->shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->end();
      if (!self->closing_) self->take_message();
    });
  }

  void take_message() {
    const Clock::time_point now = Clock::now();
    const ServerLimits& limits = server_.options_.limits;
    allowed_ = std::min(limits.burst, allowed_ + limits.messages_per_second *
                                                     std::chrono::duration<double>(now - last_message_).count());
    last_message_ = now;
    if (allowed_ < 1 || !stream_.got_text()) return close(websocket::close_code::policy_error);
    allowed_ -= 1;
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    server_.handler_.message(id_, text);
    read();
  }

  void write() {
    if (writing_ || closing_) return;
    if (!texts_.empty()) {
      going_ = std::make_shared<const std::string>(std::move(texts_.front()));
      texts_.pop_front();
      stream_.text(true);
    } else if (is_greeted_ && newest_) {
      going_ = std::make_shared<const std::string>(std::move(*newest_));
      newest_.reset();
      stream_.text(true);
    } else if (is_greeted_ && frame_ && !has_frame_) {
      going_ = std::move(frame_);
      frame_.reset();
      has_frame_ = true;
      stream_.binary(true);
    } else {
      return;
    }
    writing_ = true;
    stream_.async_write(asio::buffer(*going_), [self = this->shared_from_this()](beast::error_code error, std::size_t) {
      self->writing_ = false;
      self->going_.reset();
      if (error) return self->end();
      self->write();
    });
  }

  void close(websocket::close_code code) {
    if (std::exchange(closing_, true)) return;
    stream_.async_close(code, [self = this->shared_from_this()](beast::error_code) { self->end(); });
    // A client that does not read does not read this message either. The stream's own timeout begins again with
    // everything that the client sends.
    goodbye_.expires_after(kGoodbye);
    goodbye_.async_wait([self = this->shared_from_this()](beast::error_code error) {
      if (!error) self->drop();
    });
  }

  void end() {
    closing_ = true;
    goodbye_.cancel();
    drop();
    if (id_ == 0 || server_.sockets_.erase(id_) == 0) return;
    server_.handler_.closed(id_);
  }

  State& server_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  asio::steady_timer goodbye_{stream_.get_executor()};
  ClientId id_ = 0;
  double allowed_ = 50;  // messages
  Clock::time_point last_message_ = Clock::now();
  std::deque<std::string> texts_;
  std::optional<std::string> newest_;
  std::shared_ptr<const std::string> frame_, going_;
  bool writing_ = false, closing_ = false;
  // The first text, opened()'s greeting, has been queued; nothing else is sent before. A picture that another thread
  // posts while opened() runs may be handled sooner than the greeting: asio queues the posts of its own thread only
  // when a handler returns.
  bool is_greeted_ = false;
  bool has_frame_ = false;  // a frame not yet taken by the client
};

/// Connection until its one request has been answered, or has become a socket.
class PageServer::State::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(State& server, tcp::socket&& socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections_;
    parser_.header_limit(kHeaderBytes);
    parser_.body_limit(0);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { --server_.connections_; }

  void begin() {
    stream_.expires_after(server_.options_.limits.request_time);
    http::async_read(stream_, buffer_, parser_,
                     [self = this->shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  /// Returns the reason why the request is rejected; empty: accepted.
  [[nodiscard]] const char* refusal(const Request& request) const {
    const std::string_view host = view_of(request[http::field::host]);
    if (!has_token(view_of(request.target()), server_.options_.token))
      return "the token is missing or wrong: open the whole address that `penumbra view` printed";
    if (!is_loopback_host(host) && !is_host(host, server_.shown_host()))
      return "the request names another host than 127.0.0.1, localhost, or the address given by --host";
    if (!is_own_origin(view_of(request[http::field::origin]), host)) return "the request comes from another page";
    return nullptr;
  }

  void answer() {
    const Request& request = parser_.get();
    if (const char* why = refusal(request)) return write(say(request, http::status::forbidden, why));
    const std::string path(path_of(view_of(request.target())));
    if (path == server_.options_.socket_path && websocket::is_upgrade(request)) {
      stream_.expires_never();
      std::make_shared<Socket>(server_, stream_.release_socket())->begin(request);
      return;
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return write(say(request, http::status::method_not_allowed, "only GET and HEAD are supported"));
    if (path == "/") return write(page(request));
    const auto file = std::ranges::find(server_.options_.files, path, &ServedFile::path);
    if (file == server_.options_.files.end())
      return write(say(request, http::status::not_found, "there is no such file"));
    make(*file);
  }

  [[nodiscard]] Response page(const Request& request) const {
    std::string html = server_.options_.page;
    constexpr std::string_view kMark = "@NONCE@";
    for (std::size_t at = 0; (at = html.find(kMark, at)) != std::string::npos;)
      html.replace(at, kMark.size(), server_.nonce_);
    Response response = respond(request, http::status::ok, "text/html; charset=utf-8", std::move(html));
    const std::string host(view_of(request[http::field::host]));
    response.set("Content-Security-Policy", "default-src 'none'; script-src 'nonce-" + server_.nonce_ +
                                                "'; style-src 'nonce-" + server_.nonce_ +
                                                "'; img-src blob: data:; connect-src 'self' ws://" + host +
                                                "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    return response;
  }

  void make(const ServedFile& file) {
    stream_.expires_never();
    asio::post(server_.makers_, [this, self = this->shared_from_this(), &file]() mutable {
      Response response;
      try {
        response = respond(parser_.get(), http::status::ok, file.type, file.make(view_of(parser_.get().target())));
        if (!file.name.empty())
          response.set(http::field::content_disposition, "attachment; filename=\"" + file.name + "\"");
      } catch (const penumbra::Error& error) {
        const bool is_request = error.code() == ExitCode::usage || error.code() == ExitCode::input;
        response = say(parser_.get(), is_request ? http::status::bad_request : http::status::internal_server_error,
                       error.what());
      } catch (const std::exception& error) {
        response = say(parser_.get(), http::status::internal_server_error, error.what());
      }
      server_.post(
          [self = std::move(self), response = std::move(response)]() mutable { self->write(std::move(response)); });
    });
  }

  void write(Response response) {
    response_ = std::move(response);
    stream_.expires_after(server_.options_.limits.silence);
    http::async_write(stream_, response_, [self = this->shared_from_this()](beast::error_code, std::size_t) {
      beast::error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  State& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  Response response_;
};

PageServer::State::State(ServerOptions options, PageHandler& handler)
    : options_(std::move(options)), handler_(handler) {
  beast::error_code error;
  const asio::ip::address host = asio::ip::make_address(options_.place.host, error);
  if (error || host.is_unspecified() || host.is_multicast())
    throw UsageError("--host {}: expected one address of this machine in numbers, such as 192.168.0.7",
                     options_.place.host);
  const tcp::endpoint endpoint(host, options_.place.port);
  shown_host_ = host.is_v6() ? "[" + host.to_string() + "]" : host.to_string();
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(16, error);
  if (error)
    throw ResourceError("cannot serve on {}:{}: {}; choose another --port, or none for any that is free", shown_host_,
                        options_.place.port, error.message());
  port_ = acceptor_.local_endpoint().port();
  accept();
  thread_ = std::thread([this] { io_.run(); });
}

void PageServer::State::accept() {
  acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    // Browsers open a few connections in advance, which count as well.
    if (!error && connections_ < options_.limits.clients + 16) {
      socket.set_option(tcp::no_delay(true), error);
      std::make_shared<Connection>(*this, std::move(socket))->begin();
    }
    accept();
  });
}

void PageServer::State::send(ClientId client, std::string text) {
  if (const auto socket = sockets_.find(client); socket != sockets_.end()) socket->second->send(std::move(text));
}
void PageServer::State::send_to_all(const std::string& text) {
  for (const auto& [id, socket] : std::map(sockets_)) socket->send(text);
}
void PageServer::State::send_newest(const std::string& text, ClientId except) {
  for (const auto& [id, socket] : std::map(sockets_)) {
    if (id != except) socket->send_newest(text);
  }
}
void PageServer::State::send_frame(const std::shared_ptr<const std::string>& frame) {
  for (const auto& [id, socket] : std::map(sockets_)) socket->send_frame(frame);
}
void PageServer::State::taken(ClientId client) {
  if (const auto socket = sockets_.find(client); socket != sockets_.end()) socket->second->taken();
}

PageServer::PageServer(ServerOptions options, PageHandler& handler)
    : state_(std::make_unique<State>(std::move(options), handler)) {}
PageServer::~PageServer() = default;

std::uint16_t PageServer::port() const {
  return state_->port();
}
std::string PageServer::address() const {
  return "http://" + state_->shown_host() + ":" + std::to_string(state_->port()) + "/?token=" + state_->options().token;
}
void PageServer::stop() {
  state_->stop();
}
void PageServer::send(ClientId client, std::string text) {
  state_->post(
      [state = state_.get(), client, text = std::move(text)]() mutable { state->send(client, std::move(text)); });
}
void PageServer::send_to_all(std::string text) {
  state_->post([state = state_.get(), text = std::move(text)] { state->send_to_all(text); });
}
void PageServer::send_newest(std::string text, ClientId except) {
  state_->post([state = state_.get(), except, text = std::move(text)] { state->send_newest(text, except); });
}
void PageServer::send_frame(std::shared_ptr<const std::string> frame) {
  state_->post([state = state_.get(), frame = std::move(frame)] { state->send_frame(frame); });
}
void PageServer::taken(ClientId client) {
  state_->post([state = state_.get(), client] { state->taken(client); });
}

}  // namespace penumbra::network
