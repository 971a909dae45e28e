// SPDX-License-Identifier: Apache-2.0
// Hard shadows by volumes that are reconstructed from a shadow map: M. McCool 2000 (map_volumes.cpp). The volumes have
// no caps, since nothing is seen through the surfaces that the map shows. The walls between the eye and a view sample
// are counted, beginning at the eye.

#include "hybrids/map_volumes.hpp"
#include "hybrids/methods.hpp"
#include "hybrids/options.hpp"

#include "base/assert.hpp"
#include "maps/host/caster_maps.hpp"
#include "maps/host/options.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "visibility/pass_times.hpp"
#include "volumes/raster/volume_count.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace penumbra::hybrids {
namespace {

class ReconstructedVolume final : public visibility::Method {
 public:
  ReconstructedVolume(const render::Device& device, const visibility::MethodOptions& options)
      : device_(&device),
        description_(hybrid_volume_description()),
        options_(visibility::parse_options(description_, options)),
        casters_(device, options_[maps::kMapSize], options_[maps::kRasteriser]),
        count_(device, volumes::CountVariant::z_pass) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    casters_.upload(scene);
    count_.prepare_scene(scene);
  }
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override {
    count_.prepare_view(samples);
    eye_in_shadow_ =
        std::ranges::any_of(maps_, [&](const DepthMap& map) { return is_behind(map, glm::dvec3(samples.camera.eye)); });
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return count_.max_tile_rows(); }
  void evaluate(const visibility::Tile& tile) override { count_.count(tile); }
  void read_visibility(std::span<float> visibility) override {
    using Kind = volumes::VolumeCount::Kind;
    const std::span<const std::int32_t> counts = count_.counts();
    PENUMBRA_ASSERT(visibility.size() == counts.size(), "{} values for a tile of {} pixels", visibility.size(),
                    counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      // Where the device was in doubt, the host has counted the triangles between p and the light: the eye is not part
      // of that.
      const std::int32_t start = eye_in_shadow_ && count_.doubts()[i] == 0 ? 1 : 0;
      const Kind kind = count_.kinds()[i];
      visibility[i] = kind == Kind::lit || (kind == Kind::counted && start + counts[i] == 0) ? 1.0F : 0.0F;
    }
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    std::vector<visibility::PassTime> times = times_.take();
    std::ranges::copy(count_.take_pass_times(), std::back_inserter(times));
    return times;
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    const volumes::VolumeCount::Totals& totals = count_.totals();
    return {{"walls", totals.silhouette_edges},
            {"fragments", totals.fragments},
            {"countUpdates", totals.updates},
            {"pixelsCountedOnHost", totals.doubtful_pixels}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return casters_.memory_bytes() + count_.memory_bytes() + (buffer_ ? buffer_->bytes() : 0);
  }

 private:
  const render::Device* device_;
  visibility::MethodDescription description_;
  visibility::ParsedOptions options_;
  maps::CasterMaps casters_;
  volumes::VolumeCount count_;
  const visibility::SceneFloats* scene_ = nullptr;
  std::unique_ptr<render::Buffer> buffer_;
  std::vector<float> depths_;
  std::vector<DepthMap> maps_;  ///< faces of the light's map
  bool eye_in_shadow_ = false;
  visibility::PassTimes times_;
};

void ReconstructedVolume::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  const std::uint32_t size = options_[maps::kMapSize];
  const maps::LightBasis basis = maps::light_basis(light, *scene_);
  const glm::vec3 centre = visibility::center_of(light);
  const maps::FittedViews fitted = maps::fit_views(*scene_, light, basis, {&centre, 1}, {.size = size});
  const maps::gpu::LightView& view = fitted.views.front();
  const std::size_t texels = std::size_t{size} * size;
  depths_.resize(texels * fitted.faces);
  maps_.clear();
  volumes::LightVolumes walls;
  walls.l = centre;
  if (fitted.faces > 0) {
    maps::check_faces_fit(*device_, size, fitted.faces);
    render::grow(*device_, buffer_, "map depths", depths_.size() * sizeof(float));
    render::Commands commands(*device_);
    casters_.record(commands, view, basis, light.index, *buffer_, 0);
    times_.add(commands.submit());
    buffer_->read<float>(depths_);
  }
  for (std::uint32_t i = 0; i < fitted.faces; ++i) {
    maps_.push_back({maps::face_of(view, basis, i), std::span(depths_).subspan(i * texels, texels), size,
                     static_cast<double>(view.far), centre});
    add_walls(maps_.back(), options_[kJump], walls);
  }
  count_.prepare_light(light, std::move(walls));
}

}  // namespace

std::unique_ptr<visibility::Method> make_reconstructed_volume(const render::Device& device,
                                                              const visibility::MethodOptions& options) {
  return std::make_unique<ReconstructedVolume>(device, options);
}

}  // namespace penumbra::hybrids
