// Choosing a device: by name, number or kind, and with a reason for every one that is refused.

#include "tests/agreement/support.hpp"

#include "render/device.hpp"

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
    EXPECT_GE(devices[i].subgroup_size, 8U);
    EXPECT_GE(devices[i].max_storage_buffer_range, 1U << 27U) << "Vulkan guarantees as much";
    EXPECT_GT(devices[i].memory_bytes, 0U);
  }
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
