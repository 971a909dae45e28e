// SPDX-License-Identifier: Apache-2.0
// Device requirements of shaders: SPIR-V's capabilities, and the Vulkan features that they need.

#include "render/features.hpp"

#include "base/assert.hpp"
#include "render/optional_features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spirv_cross/spirv.h>

#include <algorithm>
#include <array>
#include <bit>

namespace penumbra::render {
namespace {

/// A feature that not every device has: `core` or `v12` is Vulkan's member for it.
struct Feature {
  SpvCapability needed_for;
  const char* name;
  vk::Bool32 vk::PhysicalDeviceFeatures::*core;
  vk::Bool32 vk::PhysicalDeviceVulkan12Features::*v12;
};
constexpr std::array kFeatures{
    Feature{SpvCapabilityFloat64, "shaderFloat64", &vk::PhysicalDeviceFeatures::shaderFloat64, nullptr},
    Feature{SpvCapabilityInt64, "shaderInt64", &vk::PhysicalDeviceFeatures::shaderInt64, nullptr},
    Feature{SpvCapabilityInt64Atomics, "shaderBufferInt64Atomics", nullptr,
            &vk::PhysicalDeviceVulkan12Features::shaderBufferInt64Atomics}};

/// Subgroup operations in compute shaders.
struct Operations {
  SpvCapability needed_for;
  const char* name;
  vk::SubgroupFeatureFlagBits bit;
};
constexpr std::array kOperations{
    Operations{SpvCapabilityGroupNonUniformVote, "subgroup votes", vk::SubgroupFeatureFlagBits::eVote},
    Operations{SpvCapabilityGroupNonUniformArithmetic, "subgroup arithmetic", vk::SubgroupFeatureFlagBits::eArithmetic},
    Operations{SpvCapabilityGroupNonUniformBallot, "subgroup ballots", vk::SubgroupFeatureFlagBits::eBallot},
    Operations{SpvCapabilityGroupNonUniformShuffle, "subgroup shuffles", vk::SubgroupFeatureFlagBits::eShuffle}};

/// Sizes for which the shaders with subgroup operations are written.
constexpr const char* kSizes = "subgroups of 4 to 64 lanes";
constexpr std::uint32_t kSmallest = 4, kLargest = 64;

/// Capabilities that every Vulkan 1.3 device supports.
constexpr std::array kEverywhere{SpvCapabilityShader, SpvCapabilitySampledBuffer};

/// Returns the name of the feature that a capability needs; null if every device has it.
const char* name_of(std::uint32_t capability) {
  if (std::ranges::find(kEverywhere, capability) != kEverywhere.end()) return nullptr;
  if (capability == SpvCapabilityGroupNonUniform) return kSizes;
  for (const Feature& feature : kFeatures) {
    if (feature.needed_for == capability) return feature.name;
  }
  for (const Operations& operations : kOperations) {
    if (operations.needed_for == capability) return operations.name;
  }
  PENUMBRA_ASSERT(false,
                  "a shader has SPIR-V capability {}: add the Vulkan feature that it needs to render/features.cpp",
                  capability);
  return nullptr;
}

/// Returns the capabilities that a module declares, in its first instructions.
std::vector<std::uint32_t> capabilities(std::span<const std::uint32_t> spirv) {
  constexpr std::size_t kHeader = 5;
  std::vector<std::uint32_t> found;
  for (std::size_t at = kHeader; at + 1 < spirv.size() && (spirv[at] & SpvOpCodeMask) == SpvOpCapability; at += 2) {
    found.push_back(spirv[at + 1]);
  }
  return found;
}

}  // namespace

OptionalFeatures optional_features(const vk::raii::PhysicalDevice& physical) {
  const auto chain = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
  OptionalFeatures there;
  for (const Feature& feature : kFeatures) {
    if (feature.core != nullptr) {
      there.core.*feature.core = chain.get<vk::PhysicalDeviceFeatures2>().features.*feature.core;
    } else {
      there.v12.*feature.v12 = chain.get<vk::PhysicalDeviceVulkan12Features>().*feature.v12;
    }
  }
  return there;
}

std::vector<std::string> lacking(const vk::raii::PhysicalDevice& physical) {
  std::vector<std::string> names;
  const OptionalFeatures there = optional_features(physical);
  for (const Feature& feature : kFeatures) {
    const vk::Bool32 has = feature.core != nullptr ? there.core.*feature.core : there.v12.*feature.v12;
    if (has == VK_FALSE) names.emplace_back(feature.name);
  }
  const auto subgroup = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>()
                            .get<vk::PhysicalDeviceSubgroupProperties>();
  for (const Operations& operations : kOperations) {
    if (!(subgroup.supportedOperations & operations.bit)) names.emplace_back(operations.name);
  }
  if (subgroup.subgroupSize < kSmallest || subgroup.subgroupSize > kLargest ||
      !std::has_single_bit(subgroup.subgroupSize))
    names.emplace_back(kSizes);
  return names;
}

std::vector<std::string> missing_for(const DeviceInfo& device, std::span<const std::uint32_t> spirv) {
  std::vector<std::string> missing;
  for (const std::uint32_t capability : capabilities(spirv)) {
    const char* name = name_of(capability);
    if (name != nullptr && std::ranges::find(device.lacks, name) != device.lacks.end()) missing.emplace_back(name);
  }
  return missing;
}

void require_features(const DeviceInfo& device, std::span<const std::uint32_t> spirv, const std::string& pass) {
  const std::vector<std::string> missing = missing_for(device, spirv);
  if (missing.empty()) return;
  throw LacksFeature("the pass \"{}\" needs {}, which the device {} lacks", pass, fmt::join(missing, ", "),
                     device.name);
}

}  // namespace penumbra::render
