// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"

#include <memory>
#include <string>

namespace penumbra::render {

/// The hardware for a run: always the processor, and one Vulkan device, which is made on first use, so that work for
/// the processor alone runs without a Vulkan loader or driver. Copies share the device, which lives as long as the last
/// of them. Thread-safe; the device itself is for one thread at a time.
class Machine {
 public:
  explicit Machine(DeviceOptions options = {});
  /// Makes a machine with an existing device, which must outlive it.
  Machine(const Device& device);  // NOLINT(google-explicit-constructor): a device is a machine that has one

  /// Begins to look for a GPU and to make its device in another thread; with `needs_device` makes a device of any kind.
  /// Errors are reported by the functions below.
  void begin(bool needs_device) const;
  /// Returns whether a device exists that is usable, permitted (DeviceOptions::wanted) and not the processor; makes
  /// that device. Throws ResourceError if the wanted device does not exist, or fails.
  [[nodiscard]] bool has_gpu() const;
  /// Returns the GPU if there is one, else a device implemented by the processor. Throws ResourceError with the reason
  /// why each device was refused.
  [[nodiscard]] const Device& device() const;
  /// Returns the name of the device, or "none" if none was made.
  [[nodiscard]] std::string device_name() const;
  /// Throws ResourceError with all messages of the validation layer since the last call: a run with messages has
  /// failed.
  void check_validation() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace penumbra::render
