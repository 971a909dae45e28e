#include "app/commands.hpp"
#include "render/device.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <cstdio>

namespace penumbra::app {
namespace {

void print_table(const std::vector<render::DeviceInfo>& devices) {
  fmt::print("{:<6} {:<52} {:<11} {:<8} {:>9}  {}\n", "index", "name", "kind", "Vulkan", "memory", "can run Penumbra");
  for (const render::DeviceInfo& device : devices) {
    const std::string verdict = device.usable() ? "yes" : fmt::format("no: {}", fmt::join(device.refusals, "; "));
    fmt::print("{:<6} {:<52} {:<11} {:<8} {:>5.1f} GiB  {}\n", device.index, device.name, device.kind,
               device.api_version, static_cast<double>(device.memory_bytes) / (1u << 30), verdict);
  }
}

void print_json(const std::vector<render::DeviceInfo>& devices) {
  auto rows = nlohmann::ordered_json::array();
  for (const render::DeviceInfo& device : devices) {
    rows.push_back({{"index", device.index},
                    {"name", device.name},
                    {"kind", device.kind},
                    {"driver", device.driver},
                    {"apiVersion", device.api_version},
                    {"usable", device.usable()},
                    {"refusals", device.refusals},
                    {"maxStorageBufferRange", device.max_storage_buffer_range},
                    {"subgroupSize", device.subgroup_size},
                    {"memoryBytes", device.memory_bytes}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"devices", rows}}.dump(2));
}

class DevicesCommand : public Command {
 public:
  explicit DevicesCommand(CLI::App& app)
      : Command(app, "devices", "list the Vulkan devices, and why one cannot be used") {
    cli_.add_flag("--json", json_, "as JSON");
  }

  int run(const GlobalOptions&) override {
    const auto devices = render::list_devices();
    if (devices.empty()) {
      spdlog::warn(
          "no Vulkan device: no loader, no driver, or VK_DRIVER_FILES points nowhere; on Debian, "
          "mesa-vulkan-drivers has one that runs on the processor");
    }
    json_ ? print_json(devices) : print_table(devices);
    return 0;
  }

 private:
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_devices_command(CLI::App& app) {
  return std::make_unique<DevicesCommand>(app);
}

}  // namespace penumbra::app
