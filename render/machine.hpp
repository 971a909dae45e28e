#pragma once

#include "render/device.hpp"

#include <memory>
#include <string>

namespace penumbra::render {

/// What work can run on: the processor, always, and one Vulkan device, which is made when it is first asked for. So
/// what runs on the processor alone works without a Vulkan loader or driver. Copies share the device, which lives as
/// long as the last of them. Two threads may ask one machine at once; the device itself is for one thread at a time.
class Machine {
 public:
  explicit Machine(DeviceOptions options = {});
  /// A machine with a device that exists already and must outlive it.
  Machine(const Device& device);  // NOLINT(google-explicit-constructor): a device is a machine that has one

  /// Begins to look for a GPU beside other work, and to make it; with `needs_device` to make a device of any kind.
  /// Errors are reported by the functions below alone.
  void begin(bool needs_device) const;
  /// Whether there is a device that can be used, may be used (DeviceOptions::wanted) and is not the processor itself;
  /// makes that device. Throws ResourceError if the wanted device is not there, or fails.
  [[nodiscard]] bool has_gpu() const;
  /// The GPU if there is one, else a device that the processor plays. Throws ResourceError with the reason why each
  /// device was refused.
  [[nodiscard]] const Device& device() const;
  /// The name of the device, or "none" if none was made.
  [[nodiscard]] std::string device_name() const;
  /// Throws ResourceError with all messages of the validation layer since the last call: a run with messages has
  /// failed.
  void check_validation() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace penumbra::render
