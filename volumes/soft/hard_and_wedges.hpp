// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/assert.hpp"
#include "visibility/method.hpp"
#include "volumes/raster/volume_count.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// Base of methods that count the hard volumes of the light's centre and draw wedges in addition: stores scene, light
/// and view samples, and reports passes and memory. A derived method adds prepare_light() and evaluate().
class HardAndWedges : public visibility::Method {
 public:
  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    count_.prepare_mesh(scene);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    count_.prepare_view(samples);
    faces_.reset();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return std::min(count_.max_tile_rows(), raster_.max_tile_rows(*samples_));
  }
  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} values for a tile of {} pixels", visibility.size(),
                    visibility_.size());
    std::ranges::copy(visibility_, visibility.begin());
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    visibility::PassTimes all;
    all.add(count_.take_pass_times());
    all.add(raster_.take_pass_times());
    return all.take();
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return {{"silhouetteEdges", wedges_.edges.size()},
            {"wedgesOnScreen", faces_ ? faces_->size() : 0},
            {"fragments", faces_ ? fragments_of(*faces_) : 0},
            {"pixelsOnHost", on_host_}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return count_.memory_bytes() + raster_.memory_bytes(); }

 protected:
  /// `options`: checked against the description; none of these methods has any.
  HardAndWedges(visibility::MethodDescription description, const visibility::MethodOptions& options, VolumeCount count,
                WedgeRaster raster)
      : description_(std::move(description)), count_(std::move(count)), raster_(std::move(raster)) {
    visibility::parse_options(description_, options);
  }

  visibility::MethodDescription description_;
  VolumeCount count_;
  WedgeRaster raster_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  LightWedges wedges_;
  std::optional<std::vector<gpu::WedgeFace>> faces_;  ///< for this view
  std::vector<float> visibility_;                     ///< of the tile evaluated last
  std::uint64_t on_host_ = 0;                         ///< pixels evaluated by the host
};

}  // namespace penumbra::volumes
