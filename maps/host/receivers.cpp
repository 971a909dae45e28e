// SPDX-License-Identifier: Apache-2.0
// Uploads view samples to the device in bands of rows.

#include "maps/host/receivers.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace penumbra::maps {

void Receivers::upload(const render::Device& device, const visibility::SceneFloats& scene,
                       const visibility::Light& light, const visibility::ViewSamples& samples) {
  width_ = samples.width;
  height_ = samples.height;
  bands_.clear();
  const std::uint32_t band_rows = max_rows(device, sizeof(gpu::Receiver));
  std::vector<gpu::Receiver> receivers;
  left_out_.clear();
  if (wanted_) left_out_.assign(samples.size(), 1);
  for (const std::uint32_t pixel : wanted_.value_or(std::vector<std::uint32_t>())) left_out_[pixel] = 0;
  for (std::uint32_t row = 0; row < height_; row += band_rows) {
    const std::uint32_t rows = std::min(band_rows, height_ - row);
    receivers.assign(std::size_t{rows} * width_, {});
    const std::size_t first = std::size_t{row} * width_;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      if (!visibility::is_receiver(scene, light, samples, first + i)) continue;
      if (wanted_ && left_out_[first + i] != 0) continue;
      const auto triangle = static_cast<std::size_t>(samples.triangle[first + i]);
      const bool casts = scene.casts_shadow[triangle] != 0;
      receivers[i] = {samples.p[first + i], samples.n[first + i],
                      casts ? scene.plane[triangle] : visibility::SceneFloats::kNoPlane,
                      casts ? scene.object[triangle] : visibility::SceneFloats::kNoPlane};
    }
    bands_.push_back({render::make_buffer<gpu::Receiver>(device, "map receivers", receivers), row, rows});
  }
}

void Receivers::leave_out(const visibility::Tile& tile, std::span<float> visibility) const {
  if (!wanted_) return;
  const std::size_t first = std::size_t{tile.first_row} * width_;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if (left_out_[first + i] != 0) visibility[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

std::vector<Receivers::Part> Receivers::parts(const visibility::Tile& tile) const {
  PENUMBRA_ASSERT(tile.first_row + tile.row_count <= height_, "tile of rows {} + {} in a picture of {}", tile.first_row,
                  tile.row_count, height_);
  std::vector<Part> parts;
  for (const Band& band : bands_) {
    const std::uint32_t first = std::max(tile.first_row, band.first_row);
    const std::uint32_t last = std::min(tile.first_row + tile.row_count, band.first_row + band.row_count);
    if (first >= last) continue;
    parts.push_back({&band.receivers, (first - band.first_row) * width_, (last - first) * width_,
                     (first - tile.first_row) * width_});
  }
  return parts;
}

std::uint64_t Receivers::memory_bytes() const {
  return std::accumulate(bands_.begin(), bands_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Band& band) { return sum + band.receivers.bytes(); });
}

std::uint32_t Receivers::max_rows(const render::Device& device, std::uint64_t bytes_per_pixel) const {
  const std::uint64_t row_bytes = std::max<std::uint64_t>(width_, 1) * bytes_per_pixel;
  const std::uint64_t rows = device.limits().max_storage_buffer_range / row_bytes;
  if (rows == 0) {
    throw ResourceError(
        "one row of {} pixels needs {} bytes, more than a buffer of {} can hold; take a narrower --size or "
        "fewer --light-samples",
        width_, row_bytes, device.info().name);
  }
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, std::max(height_, 1u)));
}

}  // namespace penumbra::maps
