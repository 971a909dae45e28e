// SPDX-License-Identifier: Apache-2.0
// The message loop of `serve` (docs/serve.md): a thread reads messages, the main thread answers them in order, and the
// log goes to the other program as messages, too. The end of the input cancels the picture in progress.

#include "app/serve/service.hpp"

#include "app/view/light_json.hpp"
#include "app/view/message_text.hpp"
#include "base/error.hpp"

#include <nlohmann/json.hpp>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <set>
#include <utility>
#include <vector>

#include <unistd.h>

namespace penumbra::app {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr int kProtocol = 1;
constexpr std::uint64_t kClient = 1;  // the only client

/// Log sink that also sends messages about written pictures to the other program.
class PipeLog final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit PipeLog(MessageSink& out) : out_(out) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text(message.payload.begin(), message.payload.end());
    const char* const level = message.level >= spdlog::level::err    ? "error"
                              : message.level >= spdlog::level::warn ? "warning"
                                                                     : "note";
    out_.send_note(in_pipe(saying(level, text)));
  }
  void flush_() override {}

 private:
  MessageSink& out_;
};

/// Sends the log to the other program during its lifetime.
class LogsToPipe {
 public:
  explicit LogsToPipe(MessageSink& out) : before_(spdlog::default_logger()) {
    auto logger = std::make_shared<spdlog::logger>("serve", std::make_shared<PipeLog>(out));
    logger->set_level(before_->level());
    spdlog::set_default_logger(std::move(logger));
  }
  LogsToPipe(const LogsToPipe&) = delete;
  LogsToPipe& operator=(const LogsToPipe&) = delete;
  ~LogsToPipe() { spdlog::set_default_logger(before_); }

 private:
  std::shared_ptr<spdlog::logger> before_;
};

std::size_t read_some(int descriptor, std::span<char> into) {
  for (;;) {
    const ssize_t got = ::read(descriptor, into.data(), into.size());
    if (got < 0 && errno == EINTR) continue;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }
}

/// Appends a list of numbers as bytes, and their description `line` to the list in the message's head.
template <typename T>
void add_buffer(std::string& bytes, ordered_json& listed, ordered_json line, const std::vector<T>& numbers) {
  constexpr std::size_t kChannelBytes = sizeof(float);
  line["channels"] = sizeof(T) / kChannelBytes;
  line["bytes"] = numbers.size() * sizeof(T);
  listed.push_back(std::move(line));
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
}

}  // namespace

/// During its lifetime, the end of the input cancels the current picture.
class Service::Renders {
 public:
  explicit Renders(Inbox& inbox) : inbox_(inbox) {
    const std::lock_guard lock(inbox_.mutex);
    if (inbox_.ended) throw InputError("the input has ended");
    inbox_.renders = true;
  }
  Renders(const Renders&) = delete;
  Renders& operator=(const Renders&) = delete;
  ~Renders() {
    const std::lock_guard lock(inbox_.mutex);
    inbox_.renders = false;
  }

 private:
  Inbox& inbox_;
};

Service::Service(session::RunOptions options, int input, int output)
    : options_(std::move(options)), out_(output), inbox_(std::make_shared<Inbox>()) {
  options_.scene = "the scene";
  // the thread blocks on input and cannot be joined
  std::thread([inbox = inbox_, input] { read_messages(inbox, input); }).detach();
}

void Service::read_messages(const std::shared_ptr<Inbox>& inbox, int input) {
  MessageSource source([input](std::span<char> into) { return read_some(input, into); });
  std::optional<PipeMessage> message;
  std::exception_ptr fault;
  do {
    try {
      message = source.next();
    } catch (...) {
      fault = std::current_exception();
      message.reset();
    }
    std::unique_lock lock(inbox->mutex);
    inbox->came.wait(lock, [&] { return !inbox->message; });
    if (message) {
      inbox->message.emplace();
      std::swap(*inbox->message, *message);
    } else {
      inbox->fault = fault;
      inbox->ended = true;
      if (inbox->renders) ::kill(::getpid(), SIGTERM);  // the picture is no longer needed
    }
    inbox->came.notify_all();
  } while (message);
}

std::optional<PipeMessage> Service::next_message() {
  for (;;) {
    {
      std::unique_lock lock(inbox_->mutex);
      inbox_->came.wait_for(lock, std::chrono::milliseconds(200), [this] { return inbox_->message || inbox_->ended; });
      if (inbox_->message) {
        std::optional<PipeMessage> message = std::exchange(inbox_->message, std::nullopt);
        inbox_->came.notify_all();
        return message;
      }
      if (inbox_->fault) std::rethrow_exception(inbox_->fault);
      if (inbox_->ended) return std::nullopt;
    }
    if (out_.is_closed()) throw ResourceError("stdout: its reader has closed it");
    if (renderer_) renderer_->watch(std::chrono::milliseconds(0));
  }
}

void Service::run() {
  const LogsToPipe logs(out_);
  out_.send(in_pipe({{"type", "hello"}, {"protocol", kProtocol}, {"version", PENUMBRA_VERSION}}));
  try {
    while (const std::optional<PipeMessage> message = next_message()) answer(*message);
  } catch (const InputError& error) {
    say("error", error.what());
    throw;
  }
  out_.finish();
}

void Service::say(std::string_view level, const std::string& text) {
  out_.send_note(in_pipe(saying(level, text)));
}

void Service::refuse(const json& message, const std::string& text) {
  ordered_json head = saying("error", text);
  head["refused"] = message["type"];
  if (const auto stamp = message.find("stamp"); stamp != message.end()) head["stamp"] = *stamp;
  out_.send_note(in_pipe(std::move(head)));
}

void Service::answer(const PipeMessage& message) {
  const auto type = message.head["type"].get<std::string>();
  try {
    if (type == "put")
      parts_.put(std::as_bytes(std::span(message.bytes)), {message.head.value("things", std::set<std::string>()),
                                                           message.head.value("shadeless", std::set<std::string>()),
                                                           message.head.value("folder", std::string())});
    else if (type == "remove")
      parts_.remove(message.head.at("things").get<std::vector<std::string>>());
    else if (type == "order")
      parts_.put_in_order(message.head.at("things").get<std::vector<std::string>>());
    else if (type == "show")
      show(message.head);
    else if (type == "render")
      render(message.head);
    else
      throw InputError("no message has the type \"{}\"", type);
  } catch (const json::exception& error) {
    refuse(message.head, fmt::format("message \"{}\": {}", type, error.what()));
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
    refuse(message.head, error.what());
  }
}

void Service::show(const json& message) {
  LiveUpdate update;
  if (const auto stamp = message.find("stamp"); stamp != message.end()) update.stamp = stamp->get<double>();
  update.moving = message.value("moving", false);
  wants_visibility_ = message.value("visibility", wants_visibility_.load());
  scenes::Camera camera = camera_;
  if (const auto change = message.find("camera"); change != message.end()) {
    camera = changed_camera(camera, *change);
    update.changes.push_back({{"type", "camera"}, {"camera", *change}});
  } else if (!renderer_) {
    throw InputError("message \"show\": the first one must contain a camera");
  }
  if (const auto size = message.find("size"); size != message.end())
    update.changes.push_back({{"type", "size"}, {"width", size->at(0)}, {"height", size->at(1)}});
  if (const auto count = message.find("lightSamples"); count != message.end())
    update.changes.push_back({{"type", "samples"}, {"count", *count}});
  if (const auto method = message.find("method"); method != message.end())
    update.changes.push_back({{"type", "method"}, {"slot", "a"}, {"entry", *method}});
  if (parts_.has_changed()) update.scene = parts_.scene(camera);
  if (!renderer_) {
    if (!update.scene) throw InputError("there is nothing to show: no scene was sent (message \"put\")");
    renderer_ = std::make_unique<LiveRenderer>(
        options_, WholeScene{update.scene->scene},
        LiveEvents{.frame = {},
                   .say = [this](std::string_view level, const std::string& text) { say(level, text); },
                   .reloaded = {},
                   .picture = [this](const std::shared_ptr<const LivePicture>& picture) { send_picture(*picture); }});
    update.scene.reset();
  }
  renderer_->update(std::move(update), kClient);
  parts_.note_shown();
  camera_ = std::move(camera);
}

void Service::render(const json& message) {
  int code = 0;
  try {
    const auto arguments = message.find("arguments");
    if (arguments == message.end() || !arguments->is_array() ||
        !std::ranges::all_of(*arguments, [](const json& argument) { return argument.is_string(); }))
      throw UsageError("message \"render\": its \"arguments\" must be a list of strings");
    const Renders renders(*inbox_);
    job_.run(arguments->get<std::vector<std::string>>());
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
    refuse(message, error.what());
    code = static_cast<int>(error.code());
  }
  out_.send(in_pipe({{"type", "done"}, {"code", code}}));
}

void Service::send_picture(const LivePicture& picture) {
  const LiveAnswer& answer = picture.answers.front();
  const std::size_t pixels = picture.samples.size();
  std::vector<glm::vec4> colors(pixels);
  for (std::size_t i = 0; i < pixels; ++i) colors[i] = glm::vec4(answer.frame.sum[i], answer.frame.alpha[i]);
  std::string bytes;
  auto buffers = ordered_json::array();
  add_buffer(bytes, buffers, {{"name", "RGBA"}}, colors);
  for (std::size_t light = 0; wants_visibility_ && light < picture.lights.size(); ++light)
    add_buffer(bytes, buffers, {{"name", "V"}, {"light", picture.lights[light]}}, answer.frame.visibility[light]);
  const auto stamp = picture.stamps.find(kClient);
  out_.send_picture(
      in_pipe({{"type", "picture"},
               {"final", picture.is_final},
               {"stamp", stamp == picture.stamps.end() ? ordered_json(nullptr) : ordered_json(stamp->second)},
               {"width", picture.samples.width},
               {"height", picture.samples.height},
               {"fullWidth", picture.full_width},
               {"fullHeight", picture.full_height},
               {"triangles", picture.triangles},
               {"method", answer.method},
               {"lightSamples", answer.light_samples},
               {"milliseconds", picture.milliseconds},
               {"buffers", std::move(buffers)}},
              bytes));
}

}  // namespace penumbra::app
