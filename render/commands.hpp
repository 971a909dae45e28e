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

/// One command buffer: passes record into it, submit() runs it to its end. Between any two recorded passes stands a
/// full memory barrier: simple, and right; what matters for speed happens inside passes.
class Commands {
 public:
  explicit Commands(const Device& device);
  ~Commands();
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;

  void fill(const Buffer& buffer, std::uint32_t value);  ///< every word of the buffer
  void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset, std::uint64_t bytes);

  /// A pass of the host's own, which happens now: what was recorded before has run and is seen by it, and it is done
  /// before whatever is recorded after it. submit() returns its time, too.
  void host_pass(const std::string& name, const std::function<void()>& work);

  /// Submits, waits, and returns the time of each pass in order (empty where the queue has no timestamps; on
  /// processors each pass is run and timed by itself).
  /// Throws ResourceError when the device is lost. The object can be recorded into again.
  std::vector<visibility::PassTime> submit();

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
