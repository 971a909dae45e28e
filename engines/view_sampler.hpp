#pragma once

#include "render/visibility_buffer.hpp"

#include <optional>

namespace penumbra::engines {

/// View samples by the faster of two ways, with the same bits: the device's visibility buffer, or, where the Vulkan
/// device is the processor itself, scan conversion on its vector units. Neither knows holes or orthographic cameras:
/// those are walked along a tree of boxes.
class ViewSampler {
 public:
  /// Uploads the scene, which must stay, if the device is to draw it.
  ViewSampler(const render::Device& device, const visibility::SceneFloats& scene);
  /// Throws ResourceError for pictures that the device cannot draw.
  visibility::ViewSamples find(const visibility::PinholeCamera& camera);

 private:
  const visibility::SceneFloats& scene_;
  std::optional<render::VisibilityBuffer> buffer_;
};

}  // namespace penumbra::engines
