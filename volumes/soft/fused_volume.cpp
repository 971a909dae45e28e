// SPDX-License-Identifier: Apache-2.0
// U. Assarsson, M. Dougherty, M. Mounier, T. Akenine-Möller, An optimized soft shadow volume algorithm with real-time
// performance, Graphics Hardware 2003: occluders one by one, instead of all together. Course notes 1.3, 5.3.2.2.

#include "volumes/soft/fused_volume.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/soft/light_parts.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

/// A copy of a scene in which one object casts shadows at a time.
class OneCaster {
 public:
  explicit OneCaster(const SceneFloats& scene) : scene_(scene) {
    for (std::uint32_t i = 0; i < scene.casts_shadow.size(); ++i) {
      if (scene.casts_shadow[i] != 0) triangles_[scene.object[i]].push_back(i);
    }
    std::ranges::fill(scene_.casts_shadow, std::uint8_t{0});
  }
  /// Returns the scene in which nothing casts, or only the object chosen by `cast`.
  [[nodiscard]] const SceneFloats& scene() const& { return scene_; }
  const SceneFloats& scene() const&& = delete;
  void cast(std::uint32_t object) {
    set(casting_, 0);
    casting_ = object;
    set(object, 1);
  }

 private:
  void set(std::uint32_t object, std::uint8_t casts) {
    const auto found = triangles_.find(object);
    if (found == triangles_.end()) return;
    for (const std::uint32_t triangle : found->second) scene_.casts_shadow[triangle] = casts;
  }

  SceneFloats scene_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> triangles_;  // casting triangles of each object
  std::uint32_t casting_ = 0;
};

class FusedVolume final : public visibility::Method {
 public:
  FusedVolume(visibility::MethodDescription description, std::unique_ptr<visibility::Method> alone,
              const FusedOptions& options)
      : description_(std::move(description)), alone_(std::move(alone)), options_(options) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const SceneFloats& scene) override {
    scene_ = &scene;
    occluders_.clear();
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      if (scene.casts_shadow[i] != 0) occluders_.push_back(scene.object[i]);
    }
    std::ranges::sort(occluders_);
    occluders_.erase(std::unique(occluders_.begin(), occluders_.end()), occluders_.end());
    visibility_.clear();
  }
  void prepare_light(const Light& light) override {
    visibility::check_light(description_, light);
    if (options_.split > 1) {
      visibility::require_kind(light, visibility::kParallelograms,
                               "; method soft-volume can divide only rectangles: use split=1");
    }
    parts_ = volumes::light_parts(light, options_.split);
    visibility_.clear();
  }
  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    visibility_.clear();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return std::max(samples_->height, 1U); }
  void evaluate(const Tile& tile) override {
    if (visibility_.empty()) fuse();
    tile_ = tile;
  }
  void read_visibility(std::span<float> visibility) override {
    const std::size_t first = std::size_t{tile_.first_row} * samples_->width;
    PENUMBRA_ASSERT(first + visibility.size() <= visibility_.size(), "{} values from {} of {}", visibility.size(),
                    first, visibility_.size());
    std::ranges::copy(std::span(visibility_).subspan(first, visibility.size()), visibility.begin());
  }

  std::vector<visibility::PassTime> take_pass_times() override { return alone_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return alone_->memory_bytes(); }

 private:
  void fuse();
  [[nodiscard]] std::vector<float> visible_with(const Light& part);

  visibility::MethodDescription description_;
  std::unique_ptr<visibility::Method> alone_;
  FusedOptions options_;
  const SceneFloats* scene_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  std::vector<std::uint32_t> occluders_;  // objects with casting triangles
  std::vector<Light> parts_;
  Tile tile_;
  std::vector<float> visibility_;  // of the whole picture
  std::map<std::string, std::uint64_t> counters_;
};

/// Returns V of the whole picture for the current scene of `alone_`.
std::vector<float> FusedVolume::visible_with(const Light& part) {
  alone_->prepare_light(part);
  alone_->prepare_view(*samples_);
  std::vector<float> visibility(samples_->size());
  const std::uint32_t rows = alone_->max_tile_rows();
  for (std::uint32_t row = 0; row < samples_->height; row += rows) {
    const Tile tile{row, std::min(rows, samples_->height - row)};
    alone_->evaluate(tile);
    alone_->read_visibility(
        std::span(visibility)
            .subspan(std::size_t{row} * samples_->width, std::size_t{tile.row_count} * samples_->width));
  }
  for (const auto& [name, value] : alone_->counters()) {
    counters_[name] = name == "largestCount" ? std::max(counters_[name], value) : counters_[name] + value;
  }
  return visibility;
}

void FusedVolume::fuse() {
  counters_ = {{"occluders", occluders_.size()}};
  struct Part {
    double weight;
    std::vector<float> whole;
    std::vector<FusedShare> share;
  };
  std::vector<Part> parts;
  double weight = 0;
  OneCaster casters(*scene_);
  alone_->prepare_mesh(casters.scene());
  for (const Light& light : parts_) {
    const double own = light.texture ? light.texture->mean_luminance : 1;
    weight += own;
    parts.push_back({own, own > 0 ? visible_with(light) : std::vector<float>(samples_->size()),
                     std::vector<FusedShare>(samples_->size())});
  }
  for (const std::uint32_t object : occluders_) {
    casters.cast(object);
    alone_->prepare_mesh(casters.scene());
    for (std::size_t k = 0; k < parts.size(); ++k) {
      Part& part = parts[k];
      if (!(part.weight > 0)) continue;
      const std::vector<float> visible = visible_with(parts_[k]);
      for_each_index(visible.size(), [&](std::size_t i) {
        const double whole = part.whole[i];
        part.share[i].add(whole - static_cast<double>(visible[i]), whole);
      });
    }
  }
  visibility_.resize(samples_->size());
  for_each_index(visibility_.size(), [&](std::size_t i) {
    double sum = 0;
    for (const Part& part : parts) {
      if (part.weight > 0) sum += part.weight * part.share[i].visible(options_.rule, part.whole[i]);
    }
    visibility_[i] = weight > 0 ? static_cast<float>(std::clamp(sum / weight, 0.0, 1.0)) : 0.0F;  // else the texture is
                                                                                                  // black
  });
}

}  // namespace

std::unique_ptr<visibility::Method> make_fused(visibility::MethodDescription description,
                                               std::unique_ptr<visibility::Method> alone, const FusedOptions& options) {
  return std::make_unique<FusedVolume>(std::move(description), std::move(alone), options);
}

}  // namespace penumbra::volumes
