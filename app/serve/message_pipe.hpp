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

/// What passes through a pipe (docs/serve.md): the length of a JSON object as a 32-bit number, little-endian; the
/// object; then so many bytes as its member "bytes" says, none without.
struct PipeMessage {
  nlohmann::json head;
  std::string bytes;
};

inline constexpr std::uint32_t kLongestHead = 1U << 20U;
inline constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30U;

/// The message in the pipe's form; `bytes` need not be said in `head`.
std::string in_pipe(nlohmann::ordered_json head, const std::string& bytes = {});

/// Reads messages. `read` fills what it is given as far as it can, and returns how much that was; 0: the end.
class MessageSource {
 public:
  using Read = std::function<std::size_t(std::span<char>)>;
  explicit MessageSource(Read read) : read_(std::move(read)) {}
  /// Nothing at the end of input. Throws InputError for what is no message: where the next one begins is then unknown.
  std::optional<PipeMessage> next();

 private:
  /// False if the input ends before the first of these bytes. Throws if it ends among them.
  bool fill(std::span<char> bytes, const char* what);

  Read read_;
};

/// Writes messages on a thread of its own, so that a reader who is slow, or has gone, stops nobody.
class MessageSink {
 public:
  /// `descriptor` is not closed.
  explicit MessageSink(int descriptor);
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;
  ~MessageSink();

  /// Messages that wait have a second to be taken; pictures none. Afterwards nothing is written any more.
  void finish();

  /// Messages are written in their order, and none is left out. Waits while a thousand of them wait.
  void send(std::string message);
  /// It takes the place of a picture that has not begun to be written.
  void send_picture(std::string message);
  /// The reader has gone.
  [[nodiscard]] bool is_closed() const;

 private:
  void work();
  bool write(std::span<const char> bytes);

  Descriptor out_;
  std::size_t piece_ = 0;  // what can be written at once without waiting
  mutable std::mutex mutex_;
  std::condition_variable wake_, room_;
  std::deque<std::string> waiting_;
  std::optional<std::string> picture_;
  bool ending_ = false, closed_ = false;
  std::thread thread_;
};

}  // namespace penumbra::app
