// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::render {

/// Thrown if a pass needs a feature that the device lacks (DeviceInfo::lacks). Other passes run on the device.
class LacksFeature : public ResourceError {
 public:
  using ResourceError::ResourceError;
};

/// Returns the features that the shader needs and the device lacks, by Vulkan's names; empty if the shader runs. Read
/// from the SPIR-V, which declares each capability that it uses.
std::vector<std::string> missing_for(const DeviceInfo& device, std::span<const std::uint32_t> spirv);

/// Throws LacksFeature, with the pass's name, if the device lacks a feature that the shader needs.
void require_features(const DeviceInfo& device, std::span<const std::uint32_t> spirv, const std::string& pass);

}  // namespace penumbra::render
