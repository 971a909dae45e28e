#pragma once

#include "app/view/live_renderer.hpp"
#include "base/error.hpp"

#include <set>
#include <string>
#include <utility>

/// Inside app/view/ only: what stops a picture that LiveRenderer is at work on.
namespace penumbra::app {

/// The state has changed while a picture of it was made.
class LiveRenderer::GivenUp : public Error {
 public:
  GivenUp() : Error(ExitCode::interrupted, "given up") {}
};

/// Passes messages on, each once, and stops final pictures that have been overtaken.
class LiveRenderer::Steps final : public Progress {
 public:
  explicit Steps(const LiveRenderer& renderer) : renderer_(renderer) {}

  /// What is at work from now on: 0: it is not given up.
  void set_revision(std::uint64_t revision) { revision_ = revision; }

  /// View samples are always finished: those of a part could not be kept.
  void begin(std::string stage, std::uint64_t) override { can_stop_ = stage != "view samples" && stage != "receivers"; }
  using Progress::advance;
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
