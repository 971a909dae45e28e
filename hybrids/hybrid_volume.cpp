// SPDX-License-Identifier: Apache-2.0
// Combines a shadow map with shadow volumes: E. Chan, F. Durand, An efficient hybrid shadow rendering algorithm, EGSR
// 2004. A view sample is at a silhouette where the four texels around it disagree; shadow volumes are drawn for these
// samples alone, under a mask that keeps all others out of the stencil, and the map decides the others. Departures: the
// map compares the receiver's plane (receiverPlane=off: its depth, as published), and view samples are masked by
// leaving them out, not by a depth test.

#include "hybrids/methods.hpp"
#include "hybrids/options.hpp"

#include "base/assert.hpp"
#include "maps/filters/methods.hpp"
#include "maps/host/error_repairs.hpp"
#include "maps/host/options.hpp"
#include "volumes/soft/methods.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace penumbra::hybrids {
namespace {

using visibility::MethodOptions;
using visibility::Tile;
using visibility::ViewSamples;

visibility::MeshVerdict hybrid_volume_verdict(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with(
              "a hard shadow from the light's centre, exact where the map's texels resolve its outlines", mesh,
              {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

visibility::ErrorRepairs hybrid_volume_repairs(const visibility::MethodDescription& method,
                                               const MethodOptions& given) {
  return maps::map_repairs(method, given,
                           {.ends_at_points = true,
                            .layers = "a point is hidden or not, by one surface or by many",
                            .fusion = "a point is hidden or not: nothing is added",
                            .gaps = "volumes are closed: there is nothing between them",
                            .falloff = "it has no penumbrae"});
}

class HybridVolume final : public visibility::Method {
 public:
  HybridVolume(const render::Device& device, const MethodOptions& options)
      : description_(hybrid_volume_description()),
        map_(maps::make_pcf(device, map_options(options))),
        volumes_(volumes::make_hard_volume(device, {})) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { map_->want_pixels(pixels); }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    map_->prepare_mesh(scene);
    volumes_->prepare_mesh(scene);
    map_says_.clear();
  }
  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    map_->prepare_light(light);
    volumes_->prepare_light(light);
    map_says_.clear();
  }
  void prepare_view(const ViewSamples& samples) override {
    samples_ = samples;
    map_->prepare_view(samples);
    volumes_->prepare_view(samples_);
    map_says_.clear();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return std::min(map_->max_tile_rows(), volumes_->max_tile_rows());
  }
  void evaluate(const Tile& tile) override {
    if (map_says_.empty()) ask_map();
    tile_ = tile;
    volumes_->evaluate(tile);
  }
  void read_visibility(std::span<float> visibility) override {
    volumes_->read_visibility(visibility);
    const std::size_t first = std::size_t{tile_.first_row} * samples_.width;
    PENUMBRA_ASSERT(first + visibility.size() <= map_says_.size(), "{} values from {} of {}", visibility.size(), first,
                    map_says_.size());
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      if (!is_silhouette(map_says_[first + i])) visibility[i] = map_says_[first + i];
    }
  }

  std::vector<visibility::PassTime> take_pass_times() override {
    std::vector<visibility::PassTime> times = map_->take_pass_times();
    const std::vector<visibility::PassTime> more = volumes_->take_pass_times();
    times.insert(times.end(), more.begin(), more.end());
    return times;
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    std::map<std::string, std::uint64_t> all = volumes_->counters();
    all.merge(map_->counters());
    all["silhouettePixels"] = static_cast<std::uint64_t>(std::ranges::count_if(map_says_, is_silhouette));
    return all;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return map_->memory_bytes() + volumes_->memory_bytes(); }

 private:
  /// Returns options of a map with bilinear weights of the four texels around a view sample: 0 or 1 where these agree.
  static MethodOptions map_options(const MethodOptions& given) {
    const visibility::MethodDescription description = hybrid_volume_description();
    static_cast<void>(visibility::parse_options(description, given));
    MethodOptions options = visibility::complete_options(description, given);
    options.erase(kVariant.name());
    options.erase(kJump.name());
    options["window"] = "1";
    options["weights"] = "bilinear";
    return options;
  }
  static bool is_silhouette(float map_says) { return map_says > 0 && map_says < 1; }

  /// Classifies all view samples, and passes those at silhouettes to the volumes.
  void ask_map() {
    map_says_.resize(samples_.size());
    const std::uint32_t rows = map_->max_tile_rows();
    for (std::uint32_t row = 0; row < samples_.height; row += rows) {
      const Tile tile{row, std::min(rows, samples_.height - row)};
      map_->evaluate(tile);
      map_->read_visibility(std::span(map_says_).subspan(std::size_t{row} * samples_.width,
                                                         std::size_t{tile.row_count} * samples_.width));
    }
    masked_ = samples_;
    for (std::size_t i = 0; i < map_says_.size(); ++i) {
      if (!is_silhouette(map_says_[i])) masked_.triangle[i] = ViewSamples::kBackground;
    }
    volumes_->prepare_view(masked_);
  }

  visibility::MethodDescription description_;
  std::unique_ptr<visibility::Method> map_, volumes_;
  ViewSamples samples_, masked_;  ///< all view samples, and those at silhouettes
  std::vector<float> map_says_;   ///< result of the map at all view samples; empty: not yet computed
  Tile tile_;
};

}  // namespace

visibility::MethodDescription hybrid_volume_description() {
  return {.name = "hybrid-volume",
          .family = visibility::Family::geometry,
          .paper = "Chan and Durand 2004; McCool 2000",
          .output = visibility::Output::scalar,
          .exact_for =
              "nothing; the hard shadow from the light's centre is exact where the map's texels resolve its outlines",
          .lights = visibility::kPlanarLights,
          .textures = false,
          .on_request = true,
          .options = {maps::kMapSize.description(), maps::kBias.description(), maps::kRasteriser.description(),
                      maps::kReceiverPlane.description(), kVariant.description(), kJump.description()},
          .verdict_on = hybrid_volume_verdict,
          .repairs = hybrid_volume_repairs};
}

std::unique_ptr<visibility::Method> make_hybrid_volume(const render::Device& device, const MethodOptions& options) {
  if (visibility::parse_options(hybrid_volume_description(), options)[kVariant] == HybridVariant::mccool) {
    return make_reconstructed_volume(device, options);
  }
  return std::make_unique<HybridVolume>(device, options);
}

}  // namespace penumbra::hybrids
