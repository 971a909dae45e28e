// SPDX-License-Identifier: Apache-2.0
#pragma once

// The two streams of a child process, read as they come.

#include <array>
#include <cerrno>
#include <cstddef>
#include <string>

#include <poll.h>
#include <unistd.h>

namespace penumbra::tests {

class ChildPipes {
 public:
  /// Reads `out` and `err`, which stay open, into texts that must outlive this.
  ChildPipes(int out, int err, std::string& out_text, std::string& err_text)
      : pipes_{{{out, POLLIN, 0}, {err, POLLIN, 0}}}, texts_{&out_text, &err_text} {}

  /// Returns false once the child has closed both.
  [[nodiscard]] bool open() const { return pipes_[0].fd >= 0 || pipes_[1].fd >= 0; }

  /// Waits for something to read, no longer than this, and reads some of it.
  void read_within(int milliseconds) {
    ::poll(pipes_.data(), pipes_.size(), milliseconds);
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      if (pipes_[i].fd < 0 || pipes_[i].revents == 0) continue;
      std::array<char, 4096> buffer{};
      const ssize_t count = ::read(pipes_[i].fd, buffer.data(), buffer.size());
      if (count > 0) {
        texts_[i]->append(buffer.data(), static_cast<std::size_t>(count));
      } else if (count == 0 || errno != EINTR) {
        pipes_[i].fd = -1;
      }
    }
  }

 private:
  std::array<pollfd, 2> pipes_;
  std::array<std::string*, 2> texts_;
};

}  // namespace penumbra::tests
