// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_fit.hpp"
#include "maps/host/map_method.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::maps {

/// Maps of all light samples, kept on the device, and the weights of the samples: for products that join the maps of
/// many points in one map from the light's centre.
class SampleMaps {
 public:
  explicit SampleMaps(const render::Device& device) : device_(&device) {}

  /// Fits the samples' maps and renders them.
  void make(const MapSource& source);

  /// Maps of samples first ... first + count - 1, one after the other.
  struct Part {
    const render::Buffer* maps;
    std::uint32_t first, count;
    std::uint32_t first_map;  ///< first face of sample `first`
  };
  /// Returns the maps in parts of at most `most` samples.
  [[nodiscard]] std::vector<Part> parts(std::uint32_t most = UINT32_MAX) const;
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// Returns the number of faces of one sample. 0: there is no receiver.
  [[nodiscard]] std::uint32_t faces() const { return faces_; }
  /// Returns a LightView for each sample.
  [[nodiscard]] const render::Buffer& views() const { return *views_; }
  /// Returns the weight of each sample, an integer: 1, or with a texture its part of total().
  [[nodiscard]] const render::Buffer& weights() const { return *weights_; }
  [[nodiscard]] std::uint32_t total() const { return total_; }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  const render::Device* device_;
  std::uint32_t count_ = 0, faces_ = 0, total_ = 0, per_buffer_ = 1;
  std::unique_ptr<render::Buffer> views_, weights_;
  std::vector<std::unique_ptr<render::Buffer>> maps_;
};

/// Light samples for look-ups that clip the light by a receiver's plane (share_above.glsl): x and y in the light's
/// basis, and the integer weight as a float.
class SamplePoints final : public MapProduct {
 public:
  explicit SamplePoints(const render::Device& device) : device_(&device) {}
  void make(const MapSource& source) override;
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return *points_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return points_ ? points_->bytes() : 0; }

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> points_;
};

/// Returns the weights of a light's samples as integers; see SampleMaps::weights.
std::vector<std::uint32_t> integer_weights(const visibility::Light& light);

}  // namespace penumbra::maps
