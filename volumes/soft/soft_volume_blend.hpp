#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace penumbra::volumes {

/// Forest, Barthe and Paulin 2006: soft shadow volumes that keep apart what different occluders cover, by boxes, in
/// each quarter of the light. docs/soft-volume-blend.md.
std::unique_ptr<visibility::Method> make_soft_volume_blend(const render::Device& device,
                                                           const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription soft_volume_blend_description();

/// What occluders cover of one quarter of the light, which is [0, 1]².
struct Cover {
  double share = 0;
  std::array<double, 4> box{1, 1, 0, 0};  ///< lower x and y, upper x and y; lower > upper: nothing

  [[nodiscard]] double box_area() const;
};

/// Adds one occluder: of its share as much as if what was there were spread evenly over its box. Between the larger of
/// the two shares and their sum.
Cover blend(const Cover& there, const Cover& added);

}  // namespace penumbra::volumes
