// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/process/terminal_progress.hpp"
#include "app/serve/message_pipe.hpp"
#include "app/serve/picture_job.hpp"
#include "app/serve/scene_parts.hpp"
#include "app/view/live_renderer.hpp"
#include "session/options.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace penumbra::app {

/// Answers the messages of another program (docs/serve.md), which ends the service by closing its input.
class Service {
 public:
  /// Reads messages from `input` and writes to `output`, descriptors that stay open. `options`: device and normals.
  Service(session::RunOptions options, int input, int output);
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() = default;

  /// Returns when the input has ended and everything except pictures has been written. Throws InputError for input that
  /// is not a message, ResourceError if the reader has closed the output.
  void run();

 private:
  /// Messages read but not yet answered.
  struct Inbox {
    std::mutex mutex;
    std::condition_variable came;
    std::optional<PipeMessage> message;  // the next message; another one is read once it has been taken
    std::exception_ptr fault;            // error of the input
    bool ended = false;
    bool renders = false;  // a picture is being written: cancelled at the end of the input
  };
  class Renders;
  static void read_messages(const std::shared_ptr<Inbox>& inbox, int input);
  [[nodiscard]] std::optional<PipeMessage> next_message();
  void answer(const PipeMessage& message);
  void show(const nlohmann::json& message);
  void render(const nlohmann::json& message);
  void send_picture(const LivePicture& picture);
  void say(std::string_view level, const std::string& text);
  /// Sends an error about a refused message, with the message's stamp if it has one.
  void refuse(const nlohmann::json& message, const std::string& text);

  session::RunOptions options_;
  MessageSink out_;

  std::shared_ptr<Inbox> inbox_;  // shared with the reading thread, which may end after this object

  SceneParts parts_;
  scenes::Camera camera_;
  std::atomic<bool> wants_visibility_ = false;
  TerminalProgress progress_{false};
  PictureJob job_{progress_};
  std::unique_ptr<LiveRenderer> renderer_;  // uses out_, therefore destroyed first
};

}  // namespace penumbra::app
