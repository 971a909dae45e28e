// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/descriptor.hpp"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

namespace penumbra::app {

/// Message of a pipe (docs/serve.md): the length of a JSON object as a 32-bit number, little-endian; the object; then
/// as many bytes as its member "bytes", by default none.
struct PipeMessage {
  nlohmann::json head;
  std::string bytes;
};

inline constexpr std::uint32_t kLongestHead = 1U << 28U;  // enough for the names of millions of things
inline constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30U;

/// Returns the message in the pipe's form; `head` need not have the member "bytes".
std::string in_pipe(nlohmann::ordered_json head, const std::string& bytes = {});

/// Reads messages. `read` fills the given span as far as possible, and returns the number of bytes; 0: end of input.
class MessageSource {
 public:
  using Read = std::function<std::size_t(std::span<char>)>;
  explicit MessageSource(Read read) : read_(std::move(read)) {}
  /// Returns the next message; nullopt at the end of input. Throws InputError if the input is not a message: the start
  /// of the next one is then unknown.
  std::optional<PipeMessage> next();

 private:
  /// Returns false if the input ends before the first of these bytes. Throws if it ends among them.
  bool fill(std::span<char> bytes, const char* what);
  /// Returns the next `count` bytes; `what` names them in errors. Throws if the input ends before them.
  std::string take(std::uint64_t count, const char* what);

  Read read_;
};

/// Writes messages on a separate thread, so that a slow or absent reader does not block the caller.
class MessageSink {
 public:
  /// `descriptor` is not closed by this object.
  explicit MessageSink(int descriptor);
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;
  ~MessageSink();

  /// Waits up to a second for waiting messages to be written; drops waiting pictures. Afterwards nothing is written.
  void finish();

  /// Writes messages in their order, without losses.
  void send(std::string message);
  /// Like send(), but drops the message if a thousand are waiting: a client that never reads blocks nothing.
  void send_note(std::string message);
  /// Replaces a waiting picture whose writing has not begun.
  void send_picture(std::string message);
  /// Returns whether the reader has closed the pipe.
  [[nodiscard]] bool is_closed() const;

 private:
  void work();
  bool write(std::span<const char> bytes);

  Descriptor out_;
  std::size_t piece_ = 0;  // number of bytes that can be written without blocking
  mutable std::mutex mutex_;
  std::condition_variable wake_, room_;
  std::deque<std::string> waiting_;
  std::optional<std::string> picture_;
  bool ending_ = false, closed_ = false;
  std::thread thread_;
};

}  // namespace penumbra::app
