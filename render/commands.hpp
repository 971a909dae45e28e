// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/pass_times.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::render {

/// A command buffer: passes record into it, submit() runs it to its end. A full memory barrier separates any two
/// recorded passes: simple and correct; performance depends on the work inside passes.
class Commands {
 public:
  explicit Commands(const Device& device);
  ~Commands();
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;

  void fill(const Buffer& buffer, std::uint32_t value);  ///< every word of the buffer
  void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset, std::uint64_t bytes);

  /// Runs `work` on the host now, as a pass: earlier recorded passes have run and are visible to `work`, which ends
  /// before later recorded passes start. submit() returns its time, too.
  void host_pass(const std::string& name, const std::function<void()>& work);

  /// Submits, waits, and returns the time of each pass in order (empty where the queue has no timestamps; on processors
  /// each pass is run and timed by itself).
  /// Throws ResourceError when the device is lost. The object can be recorded into again.
  std::vector<visibility::PassTime> submit();

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
