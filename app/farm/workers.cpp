// SPDX-License-Identifier: Apache-2.0
// Runs worker processes and repeats failed frames.

#include "app/farm/workers.hpp"

#include "app/farm/frame_logs.hpp"
#include "app/farm/tasks.hpp"
#include "app/process/child_program.hpp"
#include "app/process/process.hpp"
#include "base/error.hpp"
#include "session/process/interrupt.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>

namespace penumbra::app {
namespace {

/// Missing frames of one worker; `again`: a single frame at which a worker has already ended.
struct Run {
  std::vector<std::int64_t> frames;
  bool again = false;
};

/// Run, and its process.
class Worker {
 public:
  Worker(const Workers& workers, Run run)
      : run_(std::move(run)), logs_(workers, run_.frames), program_(command(workers, run_)) {}

  void ask_to_end() const { program_.ask_to_end(); }
  bool has_ended() {
    const bool ended = program_.has_ended();
    errors_ += program_.take_errors();
    pass_on(ended);
    return ended;
  }
  [[nodiscard]] const Run& run() const { return run_; }
  int exit_code() { return program_.exit_code(); }
  /// Returns the worker's error message, or how the worker ended.
  std::string reason() {
    if (!reason_.empty()) return reason_;
    const int code = exit_code();
    return code > 128 && code != static_cast<int>(ExitCode::interrupted)
               ? fmt::format("its worker was ended by signal {}", code - 128)
               : fmt::format("its worker ended with exit code {}", code);
  }

 private:
  static std::vector<std::string> command(const Workers& workers, const Run& run) {
    std::vector<std::string> words = workers.command;
    words.push_back("--frames=" + text_of({run.frames.front(), run.frames.back(), workers.step}));
    return words;
  }
  /// Passes on whole lines, so that lines of several workers do not mix. Keeps the beginning of an error message and
  /// everything after it.
  void pass_on(bool all) {
    constexpr std::string_view kError = "penumbra: error: ";
    for (;;) {
      const auto end = errors_.find('\n');
      if (errors_.empty() || (end == std::string::npos && !all)) return;
      const std::string line = errors_.substr(0, end);
      errors_.erase(0, end == std::string::npos ? end : end + 1);
      logs_.add(line);
      if (reason_.empty() && !line.starts_with(kError))
        say(line + "\n");
      else
        reason_ += reason_.empty() ? line.substr(kError.size()) : "\n" + line;
    }
  }

  Run run_;
  FrameLogs logs_;
  ChildProgram program_;
  std::string errors_, reason_;  // output that is not yet passed on; the kept error message
};

/// All runs of one call of render_frames.
class Supervisor {
 public:
  Supervisor(const Workers& workers, const std::vector<std::int64_t>& frames) : workers_(workers) {
    // One worker takes all frames; several get their part in four runs each, so that no worker has much left while
    // others idle.
    const std::size_t runs = workers.at_once == 1 ? 1 : 4 * workers.at_once;
    const std::size_t size = std::max<std::size_t>(1, (frames.size() + runs - 1) / runs);
    for (const session::FrameRange& range : cut_into_tasks(frames, workers.step, size, frames.size() + 1)) {
      Run& run = waiting_.emplace_back();
      std::ranges::copy_if(frames, std::back_inserter(run.frames),
                           [&](std::int64_t frame) { return frame >= range.first && frame <= range.last; });
    }
  }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  ~Supervisor() {
    for (const auto& worker : running_) worker->ask_to_end();  // asks all before it waits for the first
  }

  std::vector<FailedFrame> run() {
    while (!waiting_.empty() || !running_.empty()) {
      session::check_interrupt();
      while (!waiting_.empty() && running_.size() < workers_.at_once) {
        running_.push_back(std::make_unique<Worker>(workers_, std::move(waiting_.front())));
        waiting_.pop_front();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      for (std::size_t i = 0; i < running_.size();) {
        if (!running_[i]->has_ended()) {
          ++i;
          continue;
        }
        const std::unique_ptr<Worker> ended = std::move(running_[i]);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
        finish(*ended);
      }
    }
    std::ranges::sort(failed_, {}, &FailedFrame::frame);
    return std::move(failed_);
  }

 private:
  void finish(Worker& worker) {
    std::vector<std::int64_t> missing = worker.run().frames;
    std::erase_if(missing, workers_.is_there);
    if (missing.empty()) return;
    session::check_interrupt();  // a signal to all processes may reach workers first
    const int code = worker.exit_code();
    if (code == static_cast<int>(ExitCode::usage)) throw UsageError("{}", worker.reason());
    const std::int64_t first = missing.front();
    if (worker.run().again) {
      const bool documented = code == static_cast<int>(ExitCode::input);
      failed_.push_back({first, documented ? code : static_cast<int>(ExitCode::resource), worker.reason()});
      return;
    }
    spdlog::warn("frame {}: {}; it is tried once more", first, worker.reason());
    missing.erase(missing.begin());
    if (!missing.empty()) waiting_.push_front({std::move(missing)});
    waiting_.push_front({{first}, true});
  }

  const Workers& workers_;
  std::deque<Run> waiting_;
  std::vector<std::unique_ptr<Worker>> running_;
  std::vector<FailedFrame> failed_;
};

}  // namespace

std::vector<FailedFrame> render_frames(const Workers& workers, const std::vector<std::int64_t>& frames) {
  return Supervisor(workers, frames).run();
}

}  // namespace penumbra::app
