// SPDX-License-Identifier: Apache-2.0
// Reads and writes messages of pipes without blocking on a slow reader.

#include "app/serve/message_pipe.hpp"

#include "app/view/message_text.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace penumbra::app {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr std::size_t kMostWaiting = 1000;
static_assert(std::endian::native == std::endian::little);

std::uint64_t said_bytes(const json& head) {
  const auto bytes = head.find("bytes");
  if (bytes == head.end()) return 0;
  if (!bytes->is_number_unsigned() || bytes->get<std::uint64_t>() > kMostBytes)
    throw InputError("a message's \"bytes\" are {}; expected a number up to {}", bytes->dump(), kMostBytes);
  return bytes->get<std::uint64_t>();
}

}  // namespace

std::string in_pipe(ordered_json head, const std::string& bytes) {
  if (!bytes.empty()) head["bytes"] = bytes.size();
  const std::string text = message_text(head);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string message(sizeof(length), '\0');
  std::memcpy(message.data(), &length, sizeof(length));
  message.reserve(message.size() + text.size() + bytes.size());
  return message.append(text).append(bytes);
}

bool MessageSource::fill(std::span<char> bytes, const char* what) {
  for (std::size_t done = 0; done < bytes.size();) {
    const std::size_t more = read_(bytes.subspan(done));
    if (more == 0 && done == 0) return false;
    if (more == 0) throw InputError("the input ends within {}", what);
    done += more;
  }
  return true;
}

std::string MessageSource::take(std::uint64_t count, const char* what) {
  // Grows in steps: the announced number of bytes may be wrong.
  constexpr std::uint64_t kStep = std::uint64_t{16} << 20U;
  std::string bytes;
  while (bytes.size() < count) {
    const std::size_t before = bytes.size();
    bytes.resize(before + std::min(count - before, kStep));
    if (!fill(std::span(bytes).subspan(before), what)) throw InputError("the input ends within {}", what);
  }
  return bytes;
}

std::optional<PipeMessage> MessageSource::next() {
  std::uint32_t length = 0;
  if (!fill({reinterpret_cast<char*>(&length), sizeof(length)}, "a message's length")) return std::nullopt;
  if (length > kLongestHead) throw InputError("a message's head has {} bytes; expected up to {}", length, kLongestHead);
  PipeMessage message{parse_message(take(length, "a message's head")), {}};
  if (!message.head.is_object() || !message.head.contains("type") || !message.head["type"].is_string())
    throw InputError("a message must be an object with a \"type\"");
  message.bytes = take(said_bytes(message.head), "a message's bytes");
  return message;
}

MessageSink::MessageSink(int descriptor)
    // Opened again, not duplicated, so that O_NONBLOCK applies to this descriptor alone.
    : out_(::open(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)) {
  constexpr std::size_t kAtOnce = 512;  // a pipe reported writable by poll() always accepts this many bytes
  piece_ = out_.is_open() ? std::size_t{1} << 20U : kAtOnce;
  if (!out_.is_open()) out_ = Descriptor(::fcntl(descriptor, F_DUPFD_CLOEXEC, 3));
  if (!out_.is_open()) throw ResourceError("stdout cannot be written to");
  ::fcntl(out_.get(), F_SETPIPE_SZ, 1 << 20);  // pictures are large; failures are ignored (no pipe, or too large)
  thread_ = std::thread([this] { work(); });
}

void MessageSink::finish() {
  {
    std::unique_lock lock(mutex_);
    room_.wait_for(lock, std::chrono::seconds(1), [this] { return waiting_.empty() || closed_; });
    ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

MessageSink::~MessageSink() {
  finish();
}

void MessageSink::send(std::string message) {
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  waiting_.push_back(std::move(message));
  wake_.notify_all();
}

void MessageSink::send_note(std::string message) {
  const std::lock_guard lock(mutex_);
  if (closed_ || waiting_.size() >= kMostWaiting) return;
  waiting_.push_back(std::move(message));
  wake_.notify_all();
}

void MessageSink::send_picture(std::string message) {
  const std::lock_guard lock(mutex_);
  picture_ = std::move(message);
  wake_.notify_all();
}

bool MessageSink::is_closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

bool MessageSink::write(std::span<const char> bytes) {
  while (!bytes.empty()) {
    pollfd ready{out_.get(), POLLOUT, 0};
    if (::poll(&ready, 1, 100) == 0) {
      const std::lock_guard lock(mutex_);
      if (ending_) return false;
      continue;
    }
    const ssize_t written = ::write(out_.get(), bytes.data(), std::min(bytes.size(), piece_));
    if (written < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

void MessageSink::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ending_ || !waiting_.empty() || picture_; });
    if (ending_) return;
    const bool is_picture = waiting_.empty();
    std::string message = is_picture ? std::move(*picture_) : std::move(waiting_.front());
    if (is_picture) picture_.reset();
    lock.unlock();
    const bool written = write(message);
    lock.lock();
    if (!is_picture) waiting_.pop_front();
    if (!written) {
      closed_ = true;
      waiting_.clear();
    }
    room_.notify_all();
    if (!written) return;
  }
}

}  // namespace penumbra::app
