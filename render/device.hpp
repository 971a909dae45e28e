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

/// The device has work that it does not finish. Nobody can go on with it, or tell it to stop: after unwinding, the
/// process has to end without what runs at a regular exit (std::_Exit). Hence no ResourceError, after which some work
/// goes on.
class DeviceDoesNotAnswer : public Error {
 public:
  explicit DeviceDoesNotAnswer(const std::string& message) : Error(ExitCode::resource, message) {}
};

/// What one Vulkan device is, and why it cannot be used if it cannot.
struct DeviceInfo {
  std::uint32_t index = 0;  ///< as `--device INDEX` takes it
  std::string name;
  std::string kind;    ///< "discrete", "integrated", "virtual", "cpu", "other"
  std::string driver;  ///< driver name and version
  std::string api_version;
  std::vector<std::string> refusals;  ///< why it cannot run Penumbra; empty: it can
  std::vector<std::string> lacks;     ///< what only some passes need (missing_for): those do not run there
  std::uint64_t max_storage_buffer_range = 0;
  std::uint32_t subgroup_size = 0;
  std::uint64_t memory_bytes = 0;  ///< its largest device-local heap

  [[nodiscard]] bool usable() const { return refusals.empty(); }
};

/// All Vulkan devices on this machine; empty when there is no loader, driver or device.
std::vector<DeviceInfo> list_devices();

struct DeviceOptions {
  std::string wanted;        ///< a part of its name (case ignored), its index, "cpu", or empty: the best one
  bool validation = false;   ///< validation layer with synchronization validation; see Device::take_validation_messages
  bool only_checks = false;  ///< passes are refused or not, and never run: drivers may take seconds to compile one
};

/// Limits that code here depends on.
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

/// A Vulkan device with one queue for graphics, compute and transfer. Move-only; must outlive everything made from it.
/// Holds the on-disk pipeline cache ($XDG_CACHE_HOME/penumbra or ~/.cache/penumbra), written when it is destroyed.
class Device {
 public:
  /// Throws ResourceError that carries the reason why each device was refused.
  explicit Device(const DeviceOptions& options = {});
  /// The best usable device that is not the processor itself. Nullopt without one, without a Vulkan loader or driver,
  /// or if `options.wanted` chooses the processor. Throws ResourceError if `options.wanted` is a device that is not
  /// there or cannot be used, if the device fails, or for a validation layer that is not installed.
  static std::optional<Device> find_gpu(const DeviceOptions& options);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] const Limits& limits() const;
  /// Bytes of buffers and images alive now, and at their peak since the device was made, or forget_peak.
  [[nodiscard]] std::uint64_t allocated_bytes() const;
  [[nodiscard]] std::uint64_t peak_bytes() const;
  /// From here on the peak is counted anew, from what is alive now.
  void forget_peak() const;
  /// The second rasteriser beside this device (opengl::Context), made when first asked for: on the processor if this
  /// device is one. Throws ResourceError if there is none.
  [[nodiscard]] const opengl::Context& opengl() const;
  /// What the validation layer said since the last call (errors and warnings); always empty without validation.
  std::vector<std::string> take_validation_messages() const;

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  explicit Device(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
