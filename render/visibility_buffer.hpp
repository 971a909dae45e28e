// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::render {

/// Finds the carrying triangle of each pixel on the device. The rasteriser only proposes (each triangle's padded box on
/// the screen); coverage and order are decided per fragment in double: `visibility::cover`, then the smallest t, then
/// the smallest rank (visibility::ranks). Bit-identical to visibility::brute_force_view_samples.
class VisibilityBuffer {
 public:
  /// Returns whether the device has the features of its passes: double precision, and atomics of 64-bit integers.
  static bool runs_on(const DeviceInfo& device);
  /// Throws LacksFeature if its passes do not run on the device.
  VisibilityBuffer(const Device& device, const visibility::SceneFloats& scene);
  ~VisibilityBuffer();
  VisibilityBuffer(VisibilityBuffer&&) noexcept;
  VisibilityBuffer& operator=(VisibilityBuffer&&) noexcept;

  visibility::ViewSamples render(const visibility::PinholeCamera& camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
