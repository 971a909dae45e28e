#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// Assarsson and Akenine-Möller 2003: soft shadow volumes. docs/soft-volume.md.
std::unique_ptr<visibility::Method> make_soft_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription soft_volume_description();

}  // namespace penumbra::volumes
