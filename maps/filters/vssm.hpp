#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Variance soft shadow mapping and its kin (Lauritzen 2007, Annen et al. 2008, Yang et al. 2010): pcss whose two
/// windows are asked for moments of their depths in place of taps. docs/vssm.md.
std::unique_ptr<visibility::Method> make_vssm(const render::Device& device, const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription vssm_description();

}  // namespace penumbra::maps
