// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// Makes `view-sample` on the Vulkan device (view-sample with engine=vulkan): any planar light and pattern.
std::unique_ptr<visibility::Method> make_vulkan_view_sample(const render::Device& device);

}  // namespace penumbra::vsm
