// SPDX-License-Identifier: Apache-2.0
// The Vulkan device of a run, made when work needs one.

#include "render/machine.hpp"

#include <fmt/ranges.h>

#include <future>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

namespace penumbra::render {

struct Machine::State {
  /// Waits for the work that begin() started, and rethrows its exception. Call with the mutex held.
  void finish() {
    if (making.valid()) making.get();
  }
  void look_for_gpu() {
    if (device != nullptr || looked) return;
    own = Device::find_gpu(options);
    if (own) device = &*own;
    looked = true;
  }
  void make_device() {
    look_for_gpu();
    if (device != nullptr) return;
    own.emplace(options);
    device = &*own;
  }

  DeviceOptions options;
  std::mutex mutex;
  std::optional<Device> own;
  const Device* device = nullptr;  ///< `own`, or a device of the caller
  bool looked = false;             ///< a GPU was looked for
  std::future<void> making;        ///< works on the members above; destroyed first, which waits for its end
};

Machine::Machine(DeviceOptions options) : state_(std::make_shared<State>()) {
  state_->options = std::move(options);
}

Machine::Machine(const Device& device) : state_(std::make_shared<State>()) {
  state_->device = &device;
}

void Machine::begin(bool needs_device) const {
  State& state = *state_;
  const std::lock_guard lock(state.mutex);
  if (state.device != nullptr || state.making.valid()) return;
  try {
    state.making = std::async(std::launch::async,
                              [&state, needs_device] { needs_device ? state.make_device() : state.look_for_gpu(); });
  } catch (const std::system_error&) {  // without a thread, the device is made on first use
  }
}

bool Machine::has_gpu() const {
  const std::lock_guard lock(state_->mutex);
  state_->finish();
  state_->look_for_gpu();
  return state_->device != nullptr && state_->device->info().kind != "cpu";
}

const Device& Machine::device() const {
  const std::lock_guard lock(state_->mutex);
  state_->finish();
  state_->make_device();
  return *state_->device;
}

std::string Machine::device_name() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->making.valid()) state_->making.wait();
  return state_->device != nullptr ? state_->device->info().name : "none";
}

void Machine::check_validation() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->making.valid()) state_->making.wait();
  if (state_->device == nullptr) return;
  const auto messages = state_->device->take_validation_messages();
  if (messages.empty()) return;
  throw ResourceError("the Vulkan validation layer objects ({} messages); results cannot be trusted:\n{}",
                      messages.size(), fmt::join(messages, "\n"));
}

}  // namespace penumbra::render
