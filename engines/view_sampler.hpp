// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "render/visibility_buffer.hpp"

#include <optional>

namespace penumbra::engines {

/// Finds view samples by the faster of two engines, with the same bits: the GPU's visibility buffer, or, without a GPU,
/// scan conversion on the processor's vector units. Neither supports holes, orthographic cameras or lenses: for these a
/// tree of boxes finds the visible surfaces.
class ViewSampler {
 public:
  /// `scene`, which must outlive this object, is uploaded if a GPU draws it.
  ViewSampler(const render::Machine& machine, const visibility::SceneFloats& scene);
  /// Throws ResourceError for pictures that the device cannot draw.
  visibility::ViewSamples find(const visibility::PinholeCamera& camera);

 private:
  const visibility::SceneFloats& scene_;
  std::optional<render::VisibilityBuffer> buffer_;
};

}  // namespace penumbra::engines
