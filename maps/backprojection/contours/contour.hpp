#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Guennebaud, Barthe and Paulin 2007: contours of what shades, on one map. docs/contour.md.
std::unique_ptr<visibility::Method> make_contour(const render::Device& device,
                                                 const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription contour_description();

}  // namespace penumbra::maps
