#pragma once

#include "render/device.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::render {

/// A pass needs what the device lacks (DeviceInfo::lacks). Other passes run there.
class LacksFeature : public ResourceError {
 public:
  using ResourceError::ResourceError;
};

/// What the shader needs and the device lacks, by Vulkan's names. Empty: it runs there. Read from its SPIR-V, which
/// names each capability that it uses.
std::vector<std::string> missing_for(const DeviceInfo& device, std::span<const std::uint32_t> spirv);

/// Throws LacksFeature, which names the pass, if something is missing for one of its shaders.
void require_features(const DeviceInfo& device, std::span<const std::uint32_t> spirv, const std::string& pass);

}  // namespace penumbra::render
