// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/process/progress.hpp"

#include <penumbra/renderer.hpp>

#include <exception>

namespace penumbra {

/// Passes progress of long work to the calling program's functions, and ends the work on their request.
class LibraryProgress final : public session::Progress {
 public:
  /// `options` must outlive this object.
  explicit LibraryProgress(const RendererOptions& options) : options_(options) {}

  void begin(std::string stage, std::uint64_t steps) override;
  using session::Progress::advance;
  void advance(std::uint64_t steps) override;
  void clear() override {}
  void say(Level level, const std::string& message) override;
  /// Rethrows the exception thrown by a function of the calling program, and throws Cancelled if that function ended
  /// the call, even if other code caught the exception in between.
  void rethrow();

 private:
  void report();
  /// Calls `function` once; any exception thrown by `function` ends the work.
  template <typename Function>
  void call(const Function& function);

  const RendererOptions& options_;
  std::string stage_;
  std::uint64_t steps_ = 1, done_ = 0;
  std::exception_ptr thrown_;
};

}  // namespace penumbra
