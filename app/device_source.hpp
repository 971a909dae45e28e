#pragma once

#include "render/device.hpp"

#include <future>
#include <optional>
#include <string>

namespace penumbra::app {

/// The Vulkan device of this run, made when first asked for, or from when somebody knows that it will be. `render` and
/// `compare` always ask, whatever the method, since view samples are found on it; `inspect`, `wedges`, `convert` and
/// `methods` never do, and work without any.
class DeviceSource {
 public:
  /// `wanted` as `--device` takes it. PENUMBRA_VALIDATION=1 in the environment switches the validation layer on.
  explicit DeviceSource(std::string wanted);
  DeviceSource(const DeviceSource&) = delete;
  DeviceSource& operator=(const DeviceSource&) = delete;
  ~DeviceSource() = default;

  /// Begins to make the device beside other work. What goes wrong is told by device() alone.
  void begin();
  /// Throws ResourceError with the reason why each device was refused.
  const render::Device& device();
  /// Name of the device, or "none" if nobody asked for one.
  [[nodiscard]] std::string name() const;
  /// Throws ResourceError with all that the validation layer said so far; a run with messages is a failed run.
  void check_validation() const;

 private:
  render::DeviceOptions options_;
  std::optional<render::Device> device_;
  std::future<void> making_;  ///< of device_; its end waits for it
};

}  // namespace penumbra::app
