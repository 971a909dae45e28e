// SPDX-License-Identifier: Apache-2.0
// Uploads view samples to the device, row by row as tiles need them.

#include "engines/device/view_upload.hpp"

#include "visibility/receivers.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <cstddef>

namespace penumbra::device {

using visibility::Texel;
using visibility::TriangleTree;

void ViewUpload::prepare(const visibility::ViewSamples& samples, const visibility::SceneFloats& scene,
                         const visibility::Light& light, float scale, std::span<const std::uint32_t> tags) {
  width_ = samples.width;
  texels_.clear();
  texels_.reserve(2 * samples.size());
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    const glm::vec3 p = samples.p[pixel] * scale;
    if (!visibility::is_receiver(scene, light, samples, pixel)) {
      texels_.push_back({p, TriangleTree::kNoTriangle});
      texels_.push_back({glm::vec3(0), 0});
      continue;
    }
    const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
    const bool known = visibility::normal_is_known(scene.corners(carrier));
    texels_.push_back({p, carrier});
    texels_.push_back(
        {known ? samples.n[pixel] : glm::vec3(0), scene.plane[carrier] | (tags.empty() ? 0U : tags[carrier])});
  }
  first_row_ = row_count_ = 0;
}

void ViewUpload::load(const visibility::Tile& tile) {
  if (tile.first_row >= first_row_ && tile.first_row + tile.row_count <= first_row_ + row_count_) return;
  const auto rows = std::span<const Texel>(texels_).subspan(std::size_t{2} * tile.first_row * width_,
                                                            std::size_t{2} * tile.row_count * width_);
  render::grow(*device_, buffer_, "view samples", rows.size_bytes(), render::BufferUse::texels);
  buffer_->write(rows);
  first_row_ = tile.first_row;
  row_count_ = tile.row_count;
}

}  // namespace penumbra::device
