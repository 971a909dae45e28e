// SPDX-License-Identifier: Apache-2.0
// Tests the choice of a device: by name, number or kind, and with a reason for every device that is refused.

#include "tests/agreement/support.hpp"

#include "render/device.hpp"
#include "render/features.hpp"
#include "render/physical_device.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace penumbra::render {
namespace {

TEST(DeviceChoice, SomeDeviceIsUsable) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty()) << "no Vulkan driver: install mesa-vulkan-drivers";
  EXPECT_TRUE(std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& info) { return info.usable(); }));
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, i);
    EXPECT_FALSE(devices[i].name.empty());
    if (!devices[i].usable()) continue;
    EXPECT_GT(devices[i].subgroup_size, 0U);
    EXPECT_GE(devices[i].max_storage_buffer_range, 1U << 27U) << "Vulkan guarantees this minimum";
    EXPECT_GT(devices[i].memory_bytes, 0U);
  }
}

/// A GPU is looked for only if there is a device file through which a driver could reach one: loading all installed
/// drivers takes longer than a small picture.
TEST(DeviceChoice, NoDeviceFileNoGpu) {
#ifdef __linux__
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("penumbra-nodes-{}", ::getpid());
  std::filesystem::create_directories(folder / "dri");
  const auto make = [&](const std::string& name) { std::ofstream(folder / name) << ' '; };
  EXPECT_FALSE(has_gpu_nodes(folder / "nowhere"));
  make("dri/card0");  // a card that only displays pictures
  make("nvram");
  EXPECT_FALSE(has_gpu_nodes(folder));
  make("dri/renderD128");
  EXPECT_TRUE(has_gpu_nodes(folder));
  std::filesystem::remove(folder / "dri/renderD128");
  EXPECT_FALSE(has_gpu_nodes(folder));
  make("nvidiactl");
  EXPECT_TRUE(has_gpu_nodes(folder));
  std::filesystem::remove_all(folder);
#else
  GTEST_SKIP() << "this system has no device files to look for";
#endif
}

TEST(DeviceChoice, TakesNameIndexAndKind) {
  for (const DeviceInfo& info : list_devices()) {
    if (!info.usable()) continue;
    EXPECT_EQ(Device({std::to_string(info.index), true}).info().index, info.index);
    std::string shouted = info.name;
    std::transform(shouted.begin(), shouted.end(), shouted.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    EXPECT_EQ(Device({shouted, true}).info().name, info.name);
    if (info.kind == "cpu") {
      EXPECT_EQ(Device({"cpu", true}).info().kind, "cpu");
    }
  }
}

TEST(DeviceChoice, ARefusalNamesEveryDevice) {
  for (const char* wanted : {"no such device", "4711", "99999999999999999999999"}) {
    try {
      const Device device({wanted, true});
      ADD_FAILURE() << wanted << " is " << device.info().name;
    } catch (const ResourceError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(wanted), std::string::npos) << message;
      for (const DeviceInfo& info : list_devices()) EXPECT_NE(message.find(info.name), std::string::npos) << message;
    }
  }
}

/// Returns a module that declares these capabilities, by the numbers of SPIR-V (2.2, 2.3 and 3.31 of its
/// specification).
std::vector<std::uint32_t> module_with(const std::vector<std::uint32_t>& capabilities) {
  constexpr std::uint32_t kMagic = 0x07230203, kVersion = 0x00010600, kCapability = 17, kMemoryModel = 14;
  std::vector<std::uint32_t> words = {kMagic, kVersion, 0, 1, 0};
  for (const std::uint32_t capability : capabilities) words.insert(words.end(), {2U << 16U | kCapability, capability});
  words.insert(words.end(), {3U << 16U | kMemoryModel, 0, 10});
  return words;
}

TEST(DeviceFeatures, AModuleIsRefusedForWhatItDeclaresAndTheDeviceLacks) {
  constexpr std::uint32_t kShader = 1, kFloat64 = 10, kInt64 = 11, kInt64Atomics = 12, kSubgroups = 61, kBallots = 64;
  using Names = std::vector<std::string>;
  DeviceInfo device;
  device.name = "a device";
  const auto missing = [&](const std::vector<std::uint32_t>& capabilities) {
    return missing_for(device, module_with(capabilities));
  };
  EXPECT_EQ(missing({kShader, kFloat64, kInt64, kInt64Atomics, kSubgroups, kBallots}), Names());
  device.lacks = {"shaderFloat64", "shaderInt64", "subgroup ballots"};
  EXPECT_EQ(missing({kShader, kSubgroups, kInt64Atomics}), Names());
  EXPECT_EQ(missing({kShader, kFloat64}), Names({"shaderFloat64"}));
  EXPECT_EQ(missing({kInt64, kShader, kSubgroups, kBallots}), Names({"shaderInt64", "subgroup ballots"}));
  EXPECT_NO_THROW(require_features(device, module_with({kShader}), "easy"));
  try {
    require_features(device, module_with({kShader, kFloat64}), "exact");
    ADD_FAILURE() << "runs without shaderFloat64";
  } catch (const LacksFeature& error) {
    EXPECT_STREQ(error.what(), "the pass \"exact\" needs shaderFloat64, which the device a device lacks");
  }
}

TEST(DeviceChoice, SaysNothingToTheValidationLayer) {
  Device first({"", true});
  Device second = std::move(first);
  first = Device({"", true});
  EXPECT_TRUE(first.take_validation_messages().empty());
  EXPECT_TRUE(second.take_validation_messages().empty());
  EXPECT_EQ(Device({"", false}).take_validation_messages(), std::vector<std::string>{});
}

}  // namespace
}  // namespace penumbra::render
