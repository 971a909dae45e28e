#pragma once

#include "app/process/progress.hpp"

#include <penumbra/renderer.hpp>

#include <exception>

namespace penumbra {

/// Passes on what long work reports to the calling program's functions, and ends the work when they ask for that.
class LibraryProgress final : public app::Progress {
 public:
  /// The options must outlive it.
  explicit LibraryProgress(const RendererOptions& options) : options_(options) {}

  void begin(std::string stage, std::uint64_t steps) override;
  using app::Progress::advance;
  void advance(std::uint64_t steps) override;
  void clear() override {}
  void say(Level level, const std::string& message) override;
  /// Throws on what a function of the calling program threw, and Cancelled if that asked for the end: also where the
  /// work between caught it.
  void rethrow();

 private:
  void report();
  /// Calls it once; whatever it throws ends the work.
  template <typename Function>
  void call(const Function& function);

  const RendererOptions& options_;
  std::string stage_;
  std::uint64_t steps_ = 1, done_ = 0;
  std::exception_ptr thrown_;
};

}  // namespace penumbra
