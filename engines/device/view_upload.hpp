// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/tree_texels.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::device {

/// View samples on the device: two texels for each pixel, (p, carrying triangle) and (normal, the carrier's plane and
/// tag). p is scaled like all lengths there. Pixels that receive no shadow of the light are background
/// (TriangleTree::kNoTriangle); a normal that is not known (visibility::normal_is_known) is 0.
class ViewUpload {
 public:
  static constexpr std::uint64_t kTexelsPerPixel = 2, kBytesPerPixel = kTexelsPerPixel * sizeof(visibility::Texel);

  explicit ViewUpload(const render::Device& device) : device_(&device) {}

  /// `tags`: for each triangle, bits that are OR-ed to the index of its plane; empty: none.
  void prepare(const visibility::ViewSamples& samples, const visibility::SceneFloats& scene,
               const visibility::Light& light, float scale, std::span<const std::uint32_t> tags = {});
  void load(const visibility::Tile& tile);  ///< uploads the tile's rows unless they are on the device already

  [[nodiscard]] const render::Buffer& buffer() const { return *buffer_; }
  /// Returns the index on the device of a row of the picture that is there.
  [[nodiscard]] std::uint32_t place_of(std::uint32_t row) const { return row - first_row_; }

 private:
  const render::Device* device_;
  std::uint32_t width_ = 0;
  std::vector<visibility::Texel> texels_;
  std::uint32_t first_row_ = 0, row_count_ = 0;  // rows on the device
  std::unique_ptr<render::Buffer> buffer_;
};

}  // namespace penumbra::device
