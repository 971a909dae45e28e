// SPDX-License-Identifier: Apache-2.0
// `penumbra devices`: lists Vulkan devices and OpenGL contexts with the features that they lack, and the methods that
// do not run there; `--self-test` compares each pass on a device with its twin in C++.

#include "app/commands.hpp"
#include "app/commands/refused_methods.hpp"
#include "app/commands/self_test_report.hpp"
#include "base/error.hpp"
#include "render/device.hpp"
#include "render/opengl/context.hpp"
#include "render/visibility_buffer.hpp"
#include "selftest/self_test.hpp"
#include "session/machine.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace penumbra::app {
namespace {

std::string verdict_of(const std::vector<std::string>& refusals, const char* what) {
  return refusals.empty() ? what : fmt::format("no: {}", fmt::join(refusals, "; "));
}

/// Prints the methods that a usable device cannot run.
void print_exceptions(const render::DeviceInfo& device) {
  if (!device.usable() || device.lacks.empty()) return;
  fmt::print("\n{} {} lacks {}. These therefore do not run on it:\n", device.index, device.name,
             fmt::join(device.lacks, ", "));
  if (!render::VisibilityBuffer::runs_on(device))
    fmt::print("  {:<32} computed on the processor, with the same bits\n", "view samples");
  for (const RefusedMethod& one : refused_methods(device))
    fmt::print("  {:<32} {}\n", one.method, one.reason.substr(one.reason.find(": ") + 2));
}

void print_table(const std::vector<render::DeviceInfo>& devices,
                 const std::vector<render::opengl::ContextInfo>& contexts) {
  fmt::print("{:<6} {:<52} {:<11} {:<8} {:>9}  {}\n", "index", "name", "kind", "Vulkan", "memory", "can run Penumbra");
  for (const render::DeviceInfo& device : devices) {
    fmt::print("{:<6} {:<52} {:<11} {:<8} {:>5.1f} GiB  {}\n", device.index, device.name, device.kind,
               device.api_version, static_cast<double>(device.memory_bytes) / (1u << 30),
               verdict_of(device.refusals, device.lacks.empty() ? "yes" : "yes, with exceptions"));
  }
  for (const render::DeviceInfo& device : devices) print_exceptions(device);
  fmt::print("\n{:<12} {:<46} {:<11} {:<8}  {}\n", "EGL", "OpenGL renderer", "kind", "snaps to",
             "can draw maps (rasteriser=opengl)");
  for (const render::opengl::ContextInfo& context : contexts) {
    fmt::print("{:<12} {:<46} {:<11} {:<8}  {}\n", context.platform, context.name, context.kind,
               context.usable() ? fmt::format("2^-{}", context.subpixel_bits) : "",
               verdict_of(context.refusals, "yes; no display needed"));
  }
}

nlohmann::ordered_json json_of(const render::DeviceInfo& device) {
  auto refused = nlohmann::ordered_json::array();
  for (const RefusedMethod& one : refused_methods(device))
    refused.push_back({{"method", one.method}, {"reason", one.reason}});
  return {{"index", device.index},
          {"name", device.name},
          {"kind", device.kind},
          {"driver", device.driver},
          {"apiVersion", device.api_version},
          {"usable", device.usable()},
          {"refusals", device.refusals},
          {"lacks", device.lacks},
          {"refusedMethods", std::move(refused)},
          {"maxStorageBufferRange", device.max_storage_buffer_range},
          {"subgroupSize", device.subgroup_size},
          {"memoryBytes", device.memory_bytes}};
}

nlohmann::ordered_json json_of(const render::opengl::ContextInfo& context) {
  return {{"index", context.index},
          {"platform", context.platform},
          {"name", context.name},
          {"kind", context.kind},
          {"driver", context.driver},
          {"usable", context.usable()},
          {"refusals", context.refusals},
          {"subpixelBits", context.subpixel_bits},
          {"maxImageSize", context.max_image_size},
          {"maxStorageBlock", context.max_storage_block}};
}

class DevicesCommand : public Command {
 public:
  explicit DevicesCommand(CLI::App& app)
      : Command(
            app, "devices",
            "list the Vulkan devices and OpenGL contexts, and why any of them cannot be used, or not by some methods") {
    cli_.add_flag("--json", json_, "print JSON in place of the table");
    cli_.add_flag("--self-test", self_test_,
                  "compare every pass with its twin in C++, and both rasterisers (Vulkan's and OpenGL's) with double "
                  "arithmetic and with each other, on this machine's device and drivers; exit 1 if one fails");
    cli_.add_option("--device", device_,
                    "with --self-test: Vulkan device to test: part of its name, its index, or cpu (default: "
                    "the best)")
        ->type_name("NAME|INDEX|cpu");
    cli_.footer(
        "OpenGL needs no display: EGL gives it a context without a surface. It draws the maps of methods with "
        "rasteriser=opengl; docs/rasterisers.md says what the self-test proves.");
  }

  int run(const GlobalOptions&) override {
    if (self_test_) return run_self_test();
    if (!device_.empty())
      throw UsageError("--device {}: only --self-test takes a device; the table lists all devices", device_);
    const auto devices = render::list_devices();
    if (devices.empty()) {
      spdlog::warn(
          "no Vulkan device: no loader, no driver, or VK_DRIVER_FILES names no existing file; on Debian, "
          "mesa-vulkan-drivers has one that runs on the processor");
    }
    const auto contexts = render::opengl::list_contexts();
    if (!json_) {
      print_table(devices, contexts);
      return 0;
    }
    nlohmann::ordered_json rows{{"devices", nlohmann::ordered_json::array()},
                                {"opengl", nlohmann::ordered_json::array()}};
    for (const auto& device : devices) rows["devices"].push_back(json_of(device));
    for (const auto& context : contexts) rows["opengl"].push_back(json_of(context));
    fmt::print("{}\n", rows.dump(2));
    return 0;
  }

 private:
  [[nodiscard]] int run_self_test() const {
    const render::Machine machine = session::make_machine(device_);
    const render::Device& device = machine.device();
    const SelfTestReport report(device, selftest::run_self_test(device));
    machine.check_validation();
    json_ ? report.print_json() : report.print_table();
    return static_cast<int>(report.passed() ? ExitCode::done : ExitCode::answer_is_no);
  }

  bool json_ = false, self_test_ = false;
  std::string device_;
};

}  // namespace

std::unique_ptr<Command> make_devices_command(CLI::App& app) {
  return std::make_unique<DevicesCommand>(app);
}

}  // namespace penumbra::app
