// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/receivers.hpp"
#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace penumbra::maps {

/// V of the most recent tile, one word for each pixel, on the device: for methods without a recipe.
class TileVisibility {
 public:
  /// Allocates a tile's pixels; returns false if the tile has none.
  [[nodiscard]] bool begin(const render::Device& device, const visibility::Tile& tile, const Receivers& receivers);
  [[nodiscard]] std::uint32_t pixels() const { return pixels_; }
  /// Returns the buffer, one word for each pixel; valid after begin().
  [[nodiscard]] render::Buffer& buffer() { return *results_; }
  void read(std::span<float> visibility) const;
  [[nodiscard]] std::uint64_t memory_bytes() const { return results_ ? results_->bytes() : 0; }

 private:
  std::uint32_t pixels_ = 0;
  std::unique_ptr<render::Buffer> results_;
};

}  // namespace penumbra::maps
