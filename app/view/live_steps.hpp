// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/view/live_renderer.hpp"
#include "base/error.hpp"

#include <set>
#include <string>
#include <utility>

/// Cancellation of LiveRenderer's pictures. Internal to app/view/.
namespace penumbra::app {

/// Thrown if the state has changed during rendering.
class LiveRenderer::GivenUp : public Error {
 public:
  GivenUp() : Error(ExitCode::interrupted, "given up") {}
};

/// Passes messages on, each once, and stops final pictures that are obsolete.
class LiveRenderer::Steps final : public session::Progress {
 public:
  explicit Steps(const LiveRenderer& renderer) : renderer_(renderer) {}

  /// Sets the revision of the current picture; 0: not cancelled.
  void set_revision(std::uint64_t revision) { revision_ = revision; }

  /// Records whether the stage may stop early: the search for view samples is always completed, since a part of them
  /// could not be kept.
  void begin(std::string stage, std::uint64_t) override { can_stop_ = stage != "view samples" && stage != "receivers"; }
  using session::Progress::advance;
  void advance(std::uint64_t) override {
    if (can_stop_ && revision_ != 0 && renderer_.is_overtaken(revision_)) throw GivenUp();
  }
  void clear() override {}
  void say(Level level, const std::string& message) override {
    if (level == Level::debug || !said_.insert(message).second) return;
    renderer_.events_.say(level == Level::info ? "note" : "warning", message);
  }

 private:
  const LiveRenderer& renderer_;
  std::set<std::string> said_;
  std::uint64_t revision_ = 0;
  bool can_stop_ = false;
};

}  // namespace penumbra::app
