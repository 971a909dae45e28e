// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_view.shared.h"
#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::maps {

/// View samples on the device, in bands of rows that fit into one storage buffer each.
class Receivers {
 public:
  /// Restricts the picture to these pixels (visibility::Method::want_pixels): upload() turns the others into
  /// background.
  void want(std::span<const std::uint32_t> pixels) { wanted_.emplace(pixels.begin(), pixels.end()); }
  /// Uploads the view samples. Samples that receive no shadow of the light become background.
  void upload(const render::Device& device, const visibility::SceneFloats& scene, const visibility::Light& light,
              const visibility::ViewSamples& samples);

  /// Part of a tile in one band.
  struct Part {
    const render::Buffer* receivers;
    std::uint32_t first_receiver;  ///< index in this buffer
    std::uint32_t count;
    std::uint32_t first_result;  ///< index among the tile's pixels
    [[nodiscard]] std::uint64_t groups() const {
      return (std::uint64_t{count} + gpu::kLookupGroup - 1) / gpu::kLookupGroup;
    }
  };
  [[nodiscard]] std::vector<Part> parts(const visibility::Tile& tile) const;

  /// Writes NaN for the receivers of a tile that were not requested, as specified by visibility::Method.
  void leave_out(const visibility::Tile& tile, std::span<float> visibility) const;

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }
  [[nodiscard]] std::uint64_t memory_bytes() const;

  /// Returns the largest number of rows of this picture whose results, `bytes_per_pixel` each, fit into one storage
  /// buffer; at least 1.
  [[nodiscard]] std::uint32_t max_rows(const render::Device& device, std::uint64_t bytes_per_pixel) const;

 private:
  struct Band {
    render::Buffer receivers;
    std::uint32_t first_row, row_count;
  };
  std::uint32_t width_ = 0, height_ = 0;
  std::vector<Band> bands_;
  std::optional<std::vector<std::uint32_t>> wanted_;  ///< ascending
  std::vector<std::uint8_t> left_out_;                ///< for each pixel, if wanted_ is set: 1 for a receiver that was
                                                      ///< not requested
};

}  // namespace penumbra::maps
