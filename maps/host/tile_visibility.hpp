#pragma once

#include "maps/host/receivers.hpp"
#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace penumbra::maps {

/// V of the tile last evaluated, a word a pixel, on the device: of methods that are no recipes.
class TileVisibility {
 public:
  /// Makes room for a tile's pixels; false if it has none.
  [[nodiscard]] bool begin(const render::Device& device, const visibility::Tile& tile, const Receivers& receivers);
  [[nodiscard]] std::uint32_t pixels() const { return pixels_; }
  /// A word a pixel, after begin().
  [[nodiscard]] render::Buffer& buffer() { return *results_; }
  void read(std::span<float> visibility) const;
  [[nodiscard]] std::uint64_t memory_bytes() const { return results_ ? results_->bytes() : 0; }

 private:
  std::uint32_t pixels_ = 0;
  std::unique_ptr<render::Buffer> results_;
};

}  // namespace penumbra::maps
