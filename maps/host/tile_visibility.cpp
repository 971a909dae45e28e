// SPDX-License-Identifier: Apache-2.0
// Reads V of a tile from the device.

#include "maps/host/tile_visibility.hpp"

#include "base/assert.hpp"

namespace penumbra::maps {

bool TileVisibility::begin(const render::Device& device, const visibility::Tile& tile, const Receivers& receivers) {
  pixels_ = tile.row_count * receivers.width();
  if (pixels_ == 0) return false;
  render::grow(device, results_, "map visibility", std::uint64_t{pixels_} * sizeof(std::uint32_t));
  return true;
}

void TileVisibility::read(std::span<float> visibility) const {
  PENUMBRA_ASSERT(visibility.size() == pixels_, "{} values for a tile of {} pixels", visibility.size(), pixels_);
  if (!visibility.empty()) results_->read(visibility);
}

}  // namespace penumbra::maps
