// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "render/opengl/context.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::render {

/// The device has work that it does not finish. The process cannot continue with the device, or stop it: after
/// unwinding, the process must end without a regular exit's actions (std::_Exit). Therefore not a ResourceError, after
/// which some callers continue.
class DeviceDoesNotAnswer : public Error {
 public:
  explicit DeviceDoesNotAnswer(const std::string& message) : Error(ExitCode::resource, message) {}
};

/// Description of a Vulkan device, with the reasons why it cannot be used, if any.
struct DeviceInfo {
  std::uint32_t index = 0;  ///< as `--device INDEX` takes it
  std::string name;
  std::string kind;    ///< "discrete", "integrated", "virtual", "cpu", "other"
  std::string driver;  ///< driver name and version
  std::string api_version;
  std::vector<std::string> refusals;  ///< reasons why it cannot run Penumbra; empty: it can
  std::vector<std::string> lacks;     ///< features that only some passes need (missing_for): those passes do not run on
                                      ///< it
  std::uint64_t max_storage_buffer_range = 0;
  std::uint32_t subgroup_size = 0;
  std::uint64_t memory_bytes = 0;  ///< size of its largest device-local heap

  [[nodiscard]] bool usable() const { return refusals.empty(); }
};

/// Returns all Vulkan devices on this machine; empty without a loader, driver or device.
std::vector<DeviceInfo> list_devices();

struct DeviceOptions {
  std::string wanted;        ///< a part of the name (case ignored), the index, "cpu", or empty: the best device
  bool validation = false;   ///< validation layer with synchronization validation; see Device::take_validation_messages
  bool only_checks = false;  ///< passes are created only to check whether they are refused, and never run: their
                             ///< compilation, which may take seconds, is skipped
};

/// Device limits that code here depends on.
struct Limits {
  std::uint64_t max_storage_buffer_range = 0;
  std::uint32_t subgroup_size = 0;
  std::uint32_t max_shared_memory = 0;
  std::uint32_t max_workgroup_count = 0;  ///< in x
  std::uint32_t max_image_size = 0;
  std::uint32_t max_texel_buffer_elements = 0;
  std::uint32_t subpixel_bits = 0;  ///< the rasteriser snaps corners to 2^-bits of a pixel
  double timestamp_period = 0;      ///< nanoseconds a tick; 0: no timestamps
};

/// A Vulkan device with one queue for graphics, compute and transfer. Move-only; must outlive all objects made from it.
/// Holds the on-disk pipeline cache ($XDG_CACHE_HOME/penumbra or ~/.cache/penumbra), written by the destructor.
class Device {
 public:
  /// Throws ResourceError with the reason why each device was refused.
  explicit Device(const DeviceOptions& options = {});
  /// Returns the best usable device other than the processor. Returns nullopt without one, without a Vulkan loader or
  /// driver, or if `options.wanted` chooses the processor. Throws ResourceError if `options.wanted` is a device that
  /// does not exist or cannot be used, if the device fails, or for a validation layer that is not installed.
  static std::optional<Device> find_gpu(const DeviceOptions& options);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] const Limits& limits() const;
  /// Bytes of buffers and images: currently allocated, and the peak since the device was made or forget_peak() was
  /// called.
  [[nodiscard]] std::uint64_t allocated_bytes() const;
  [[nodiscard]] std::uint64_t peak_bytes() const;
  /// Resets the peak to the bytes currently allocated.
  void forget_peak() const;
  /// Returns the second rasteriser (opengl::Context), made on first use: on the processor if this device is one. Throws
  /// ResourceError if there is none.
  [[nodiscard]] const opengl::Context& opengl() const;
  /// Returns the validation layer's messages since the last call (errors and warnings); always empty without
  /// validation.
  std::vector<std::string> take_validation_messages() const;

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  explicit Device(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
