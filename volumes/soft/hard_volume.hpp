#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// Crow 1977: the hard shadow of the light's centre by shadow volumes. docs/hard-volume.md.
std::unique_ptr<visibility::Method> make_hard_volume(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription hard_volume_description();

}  // namespace penumbra::volumes
