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

/// View samples on the device: two texels a pixel, (p, carrying triangle) and (normal, the carrier's plane and tag).
/// p is scaled like everything there. What receives no shadow of the light is background (TriangleTree::kNoTriangle);
/// where a triangle's normal is not known (visibility::normal_is_known), it is 0.
class ViewUpload {
 public:
  static constexpr std::uint64_t kTexelsPerPixel = 2, kBytesPerPixel = kTexelsPerPixel * sizeof(visibility::Texel);

  explicit ViewUpload(const render::Device& device) : device_(&device) {}

  /// `tags`: for each triangle bits to be OR-ed to the number of its plane; empty: none.
  void prepare(const visibility::ViewSamples& samples, const visibility::SceneFloats& scene,
               const visibility::Light& light, float scale, std::span<const std::uint32_t> tags = {});
  void load(const visibility::Tile& tile);  ///< if its rows are not on the device yet

  [[nodiscard]] const render::Buffer& buffer() const { return *buffer_; }
  /// A row of the picture, of those that are on the device.
  [[nodiscard]] std::uint32_t place_of(std::uint32_t row) const { return row - first_row_; }

 private:
  const render::Device* device_;
  std::uint32_t width_ = 0;
  std::vector<visibility::Texel> texels_;
  std::uint32_t first_row_ = 0, row_count_ = 0;  // on the device
  std::unique_ptr<render::Buffer> buffer_;
};

}  // namespace penumbra::device
