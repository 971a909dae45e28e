// SPDX-License-Identifier: Apache-2.0
// Computes V in a map of the receivers: Atty, Holzschuch, Lapierre, Hasenfratz, Hansen and Sillion, "Soft shadow maps:
// efficient sampling of light source visibility" (Computer Graphics Forum 25 (4), 2006). Departures: extents are
// computed for each axis, so that light and map need not have the same aspect; the second pass draws the farthest
// surface in place of the farthest back face, since closed meshes do not distinguish the two and triangle soups have no
// back faces; sums are integers in place of blended floats (precision=fp16: 16-bit floats, as published); each receiver
// texel gathers occluders (form=scatter: as published), with the same sums; shadows on occluders, which the paper
// leaves out, may come from another method (self=backproject).

#include "maps/backprojection/soft_shadow_map/methods.hpp"

#include "base/assert.hpp"
#include "maps/backprojection/patches/methods.hpp"
#include "maps/backprojection/soft_shadow_map/soft_gather.comp.spv.hpp"
#include "maps/backprojection/soft_shadow_map/soft_resolve.comp.spv.hpp"
#include "maps/backprojection/soft_shadow_map/soft_scatter.comp.spv.hpp"
#include "maps/backprojection/soft_shadow_map/soft_scene.hpp"
#include "maps/backprojection/soft_shadow_map/soft_settings.hpp"
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.comp.spv.hpp"
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.shared.h"
#include "maps/host/caster_maps.hpp"
#include "maps/backprojection/light_table.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/receivers.hpp"
#include "maps/host/scene_space.hpp"
#include "maps/host/tile_visibility.hpp"
#include "render/compute_pass.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace penumbra::maps {
namespace {

/// Largest number of iterations of a loop in one pass: drivers for processors end all loops of a workgroup after
/// 65,535.
constexpr std::uint32_t kMostTurns = 60000;
constexpr std::uint32_t kPassesPerSubmission = 96;

class SoftShadowMap final : public visibility::Method, public SeesScene {
 public:
  /// `self`: the method for V on occluders; null: V there is the fraction of the light above the horizon.
  SoftShadowMap(const render::Device& device, const MapOptions& map, const SoftSettings& settings,
                std::unique_ptr<visibility::Method> self);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void see_through(const SceneSpace& space) override {
    space_ = space;
    if (auto* sees = dynamic_cast<SeesScene*>(self_.get())) sees->see_through(space);
  }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    if (self_) self_->prepare_mesh(scene);
  }
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    const std::uint32_t rows = receivers_.max_rows(*device_, sizeof(std::uint32_t));
    return self_ ? std::min(rows, self_->max_tile_rows()) : rows;
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override {
    std::vector<visibility::PassTime> times = times_.take();
    if (self_) std::ranges::copy(self_->take_pass_times(), std::back_inserter(times));
    return times;
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  /// Map of some triangles from the light's centre, on the device and read back.
  struct Map {
    gpu::LightView view{};
    std::uint32_t faces = 0;
    std::vector<float> depths;
  };
  /// Surface that a map stores for each texel. The depth of an empty texel is 1; where the farthest is kept, 0.
  enum class Kept : std::uint8_t { nearest, nearest_two, farthest };
  /// Draws the triangles in a view. If two layers are kept, the second follows the first in the buffer, and is not read
  /// back.
  Map draw(CasterMaps& casters, const gpu::LightView& view, std::uint32_t size, Kept kept,
           std::unique_ptr<render::Buffer>& buffer);
  [[nodiscard]] SoftViews views() const;
  void make_maps();
  /// Returns whether a pass's texels represent the farthest surfaces (section 3.5; figure 11b: in one pass, too).
  [[nodiscard]] bool of_farthest(std::uint32_t pass) const {
    return pass > 0 || settings_.patches == SoftPatches::bottom;
  }
  void add_up(const Map& occluders, std::uint32_t pass);
  [[nodiscard]] gpu::SoftMapPush push_for(const Map& occluders, int side, std::uint32_t pass) const;

  const render::Device* device_;
  visibility::MethodDescription description_;
  MapOptions map_;
  SoftSettings settings_;
  std::unique_ptr<visibility::Method> self_;
  std::vector<std::uint32_t> on_occluder_;  ///< for each pixel of the last evaluated tile: 1 if it shows an occluder
  CasterMaps occluder_maps_, receiver_maps_;
  render::ComputePass gather_, scatter_, resolve_, look_up_;
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  SceneSpace space_;  ///< space of the camera
  const visibility::ViewSamples* samples_ = nullptr;
  bool maps_are_old_ = false;  ///< the maps were made for another view
  const visibility::Light* light_ = nullptr;
  LightBasis basis_;
  LightTable light_table_;
  gpu::LightTableHead light_shape_{};
  bool upright_ = false;  ///< the light is a rectangle along its basis, without texture
  SoftScene parts_;
  Map receiver_map_;
  TileVisibility results_;
  std::unique_ptr<render::Buffer> occluders_, receiver_depths_, visible_, sums_, counts_, views_;
};

SoftShadowMap::SoftShadowMap(const render::Device& device, const MapOptions& map, const SoftSettings& settings,
                             std::unique_ptr<visibility::Method> self)
    : device_(&device),
      description_(soft_shadow_map_description()),
      map_(map),
      settings_(settings),
      self_(std::move(self)),
      occluder_maps_(device, map.size, map.rasteriser),
      receiver_maps_(device, settings.receiver_size, map.rasteriser),
      gather_(device, {.name = "gather occluders",
                       .spirv = shaders::kSoftGatherComp,
                       .push_bytes = sizeof(gpu::SoftMapPush),
                       .constants = {}}),
      scatter_(device, {.name = "scatter occluders",
                        .spirv = shaders::kSoftScatterComp,
                        .push_bytes = sizeof(gpu::SoftMapPush),
                        .constants = {}}),
      resolve_(device, {.name = "soft shadow map",
                        .spirv = shaders::kSoftResolveComp,
                        .push_bytes = sizeof(gpu::SoftMapPush),
                        .constants = {}}),
      look_up_(device, {.name = "soft shadow map look-up",
                        .spirv = shaders::kSoftShadowMapComp,
                        .push_bytes = sizeof(gpu::LookupPush) + sizeof(gpu::SoftLookupPush),
                        .constants = {}}),
      light_table_(device) {}

SoftViews SoftShadowMap::views() const {
  if (!map_.fit.sees_camera()) {
    return {fit_window(*scene_, basis_, parts_.receivers, settings_.receiver_size, light_->two_sided),
            fit_window(*scene_, basis_, parts_.occluders, map_.size, light_->two_sided)};
  }
  visibility::SceneFloats seen = *scene_;
  seen.receives_shadow = parts_.receivers;
  const std::vector<BodyPoint> points =
      body_points(seen, *light_, basis_, *samples_, map_.fit.body, 0, std::numeric_limits<double>::infinity(), space_);
  const LightBounds light = light_bounds(*light_, basis_);
  return fit_to_camera(*scene_, basis_, parts_,
                       {.points = points,
                        .reach = glm::max(-light.lower, light.upper),
                        .receiver_size = settings_.receiver_size,
                        .occluder_size = map_.size,
                        .two_sided = light_->two_sided,
                        .snap = map_.fit.snap});
}

SoftShadowMap::Map SoftShadowMap::draw(CasterMaps& casters, const gpu::LightView& view, std::uint32_t size, Kept kept,
                                       std::unique_ptr<render::Buffer>& buffer) {
  Map map;
  const std::uint32_t layers = kept == Kept::nearest_two ? 2 : 1;
  map.view = view;
  map.faces = map.view.side[0].face_count + map.view.side[1].face_count;
  check_faces_fit(*device_, size, layers * std::max(map.faces, 1u));
  map.depths.resize(std::size_t{std::max(map.faces, 1u)} * size * size);
  render::grow(*device_, buffer, "soft shadow map depths", layers * map.depths.size() * sizeof(float));
  if (map.faces == 0) return map;
  render::Commands commands(*device_);
  if (kept == Kept::farthest) {
    casters.record_farthest(commands, map.view, basis_, light_->index, *buffer, 0);
  } else {
    casters.record(commands, map.view, basis_, light_->index, *buffer, 0);
    times_.add(commands.submit());
    if (kept == Kept::nearest_two) {
      casters.record_behind(commands, map.view, basis_, light_->index, *buffer, map.faces, 0);
    }
  }
  times_.add(commands.submit());
  buffer->read<float>(map.depths);
  return map;
}

void SoftShadowMap::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  light_ = &light;
  if (self_) self_->prepare_light(light);
  basis_ = light_basis(light);
  const LightTableData shape = light_table(light, basis_);
  light_table_.write(shape);
  light_shape_ = shape.head;
  upright_ = shape.head.width * shape.head.height == 1;
  parts_ = part_scene(*scene_, light, basis_);

  visibility::SceneFloats drawn = *scene_;
  drawn.casts_shadow = parts_.receivers;
  receiver_maps_.upload(drawn);
  drawn.casts_shadow = parts_.occluders;
  occluder_maps_.upload(drawn);
  counters_ = {{"patches", 0}, {"fragments", 0}, {kPixelsOnOccluders, 0}};
  // A camera's maps are made when there are view samples.
  maps_are_old_ = map_.fit.sees_camera();
  if (!maps_are_old_) make_maps();
}

void SoftShadowMap::make_maps() {
  maps_are_old_ = false;
  counters_["patches"] = counters_["fragments"] = 0;
  const SoftViews views = this->views();
  receiver_map_ = draw(receiver_maps_, views.receivers, settings_.receiver_size, Kept::nearest, receiver_depths_);
  render::grow(*device_, visible_, "soft shadow map", receiver_map_.depths.size() * sizeof(float));
  render::grow(*device_, counts_, "fragments", 2 * sizeof(std::uint32_t));
  for (std::uint32_t pass = 0; pass < settings_.passes; ++pass) {
    const Kept nearest = map_.depth == DepthUse::first ? Kept::nearest : Kept::nearest_two;
    add_up(draw(occluder_maps_, views.occluders, map_.size, of_farthest(pass) ? Kept::farthest : nearest, occluders_),
           pass);
  }
  render::grow(*device_, views_, "map views", sizeof(gpu::LightView));
  views_->write<gpu::LightView>(std::span(&receiver_map_.view, 1));
}

/// Returns the least and the greatest of the depths of non-empty texels in one face of a map.
std::pair<float, float> extremes(std::span<const float> depths) {
  std::pair<float, float> found(1, 0);
  for (const float depth : depths) {
    if (depth <= 0 || depth >= 1) continue;
    found.first = std::min(found.first, depth);
    found.second = std::max(found.second, depth);
  }
  return found;
}

gpu::SoftMapPush SoftShadowMap::push_for(const Map& occluders, int side, std::uint32_t pass) const {
  const gpu::SideView &from = occluders.view.side[side], &to = receiver_map_.view.side[side];
  const std::uint32_t size = map_.size, receiver_size = settings_.receiver_size;
  gpu::SoftMapPush push{};
  push.occluder_lower = from.lower;
  push.occluder_texel = (from.upper - from.lower) / static_cast<float>(size);
  push.receiver_lower = to.lower;
  push.receiver_texel = (to.upper - to.lower) / static_cast<float>(receiver_size);
  push.light_lower = light_shape_.lower;
  push.light_upper = light_shape_.upper;
  push.upright = upright_ ? 1 : 0;
  push.occluder_far = occluders.view.far;
  push.receiver_far = receiver_map_.view.far;
  push.bias = static_cast<float>(map_.bias);
  push.occluder_size = size;
  push.receiver_size = receiver_size;
  push.occluder_first = from.first_face * size * size;
  push.receiver_first = to.first_face * receiver_size * receiver_size;
  push.half_floats = settings_.precision == SoftPrecision::fp16 ? 1 : 0;
  push.later = pass > 0 ? 1 : 0;
  // The farthest surfaces have no surface behind them.
  push.depth_use = of_farthest(pass) ? gpu::kDepthFirst : static_cast<std::uint32_t>(map_.depth);
  push.second_first = push.occluder_first + occluders.faces * size * size;
  push.nearest = extremes(std::span(occluders.depths).subspan(push.occluder_first, std::size_t{size} * size)).first *
                 push.occluder_far;
  push.deepest =
      extremes(std::span(receiver_map_.depths).subspan(push.receiver_first, std::size_t{receiver_size} * receiver_size))
          .second *
      push.receiver_far;
  return push;
}

void SoftShadowMap::add_up(const Map& occluders, std::uint32_t pass) {
  counters_["patches"] += static_cast<std::uint64_t>(
      std::ranges::count_if(occluders.depths, [](float depth) { return depth > 0 && depth < 1; }));
  render::Commands commands(*device_);
  if (pass == 0) commands.fill(*visible_, 0x3f800000u);  // 1.0f
  commands.fill(*counts_, 0);
  for (int side = 0; side < 2; ++side) {
    if (occluders.view.side[side].face_count == 0 || receiver_map_.view.side[side].face_count == 0) continue;
    gpu::SoftMapPush push = push_for(occluders, side, pass);
    const bool gathers = settings_.form == SoftForm::gather;
    const auto groups = [](std::uint64_t texels) { return (texels + gpu::kLookupGroup - 1) / gpu::kLookupGroup; };
    const std::uint64_t receiver_texels = std::uint64_t{push.receiver_size} * push.receiver_size;
    const std::uint64_t occluder_texels = std::uint64_t{push.occluder_size} * push.occluder_size;
    render::grow(*device_, sums_, "soft shadow map sums", receiver_map_.depths.size() * 2 * sizeof(std::uint32_t));
    commands.fill(*sums_, 0);
    const std::uint32_t across = gathers ? push.occluder_size : push.receiver_size;
    const std::uint32_t rows = std::max(kMostTurns / across, 1u);
    for (std::uint32_t row = 0; row < across; row += rows) {
      push.first_row = row;
      push.last_row = std::min(row + rows, across);
      (gathers ? gather_ : scatter_)
          .record(commands, push, {*occluders_, *receiver_depths_, *sums_, *counts_, light_table_.buffer()},
                  groups(gathers ? receiver_texels : occluder_texels));
      if (row / rows % kPassesPerSubmission == kPassesPerSubmission - 1) times_.add(commands.submit());
    }
    resolve_.record(commands, push, {*sums_, *visible_}, groups(receiver_texels));
    times_.add(commands.submit());
  }
  times_.add(commands.submit());
  std::array<std::uint32_t, 2> fragments{};
  counts_->read<std::uint32_t>(fragments);
  counters_["fragments"] += std::uint64_t{fragments[1]} << 32 | fragments[0];
}

void SoftShadowMap::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: prepare_view before prepare_light", description_.name);
  samples_ = &samples;
  maps_are_old_ = map_.fit.sees_camera();
  if (self_) self_->prepare_view(samples);
  receivers_.upload(*device_, *scene_, *light_, samples);
}

void SoftShadowMap::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: evaluate before prepare_light", description_.name);
  if (!results_.begin(*device_, tile, receivers_)) return;
  if (maps_are_old_) make_maps();
  if (self_) self_->evaluate(tile);
  on_occluder_.assign(results_.pixels(), 0);
  for (std::size_t i = 0; i < on_occluder_.size(); ++i) {
    const std::int32_t triangle = samples_->triangle[std::size_t{tile.first_row} * receivers_.width() + i];
    on_occluder_[i] = triangle >= 0 && parts_.receivers[static_cast<std::size_t>(triangle)] == 0 ? 1 : 0;
  }
  counters_[kPixelsOnOccluders] += static_cast<std::uint64_t>(std::ranges::count(on_occluder_, 1u));
  results_.buffer().write<std::uint32_t>(on_occluder_);
  const gpu::SoftLookupPush own{.size = settings_.receiver_size,
                                .linear = settings_.filter == SoftFilter::linear ? 1u : 0u};
  render::Commands commands(*device_);
  for (const Receivers::Part& part : receivers_.parts(tile)) {
    gpu::LookupPush push{};
    push.basis = basis_.rounded();
    push.two_sided = light_->two_sided ? 1 : 0;
    push.first_receiver = part.first_receiver;
    push.receiver_count = part.count;
    push.first_result = part.first_result;
    const std::vector<std::uint32_t> words = push_words(push, own);
    const std::vector<render::BufferReference> buffers{*part.receivers,   *views_,   *receiver_depths_,
                                                       results_.buffer(), *visible_, light_table_.buffer()};
    look_up_.record(commands, std::as_bytes(std::span(words)), buffers, part.groups());
  }
  times_.add(commands.submit());
}

void SoftShadowMap::read_visibility(std::span<float> visibility) {
  results_.read(visibility);
  if (!self_ || visibility.empty()) return;
  std::vector<float> on_themselves(visibility.size());
  self_->read_visibility(on_themselves);
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if (on_occluder_[i] != 0) visibility[i] = on_themselves[i];
  }
}

std::uint64_t SoftShadowMap::memory_bytes() const {
  std::uint64_t bytes = (self_ ? self_->memory_bytes() : 0) + occluder_maps_.memory_bytes() +
                        receiver_maps_.memory_bytes() + receivers_.memory_bytes() + results_.memory_bytes();
  for (const auto* buffer : {&occluders_, &receiver_depths_, &visible_, &sums_, &counts_, &views_}) {
    bytes += *buffer ? (*buffer)->bytes() : 0;
  }
  return bytes;
}

}  // namespace

std::unique_ptr<visibility::Method> make_soft_shadow_map(const render::Device& device,
                                                         const visibility::MethodOptions& options) {
  const visibility::MethodDescription description = soft_shadow_map_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  const SoftSettings settings = soft_settings(parsed);
  const MapOptions map = map_options(device, description, parsed);
  std::unique_ptr<visibility::Method> self;
  if (settings.self == SoftSelf::backproject) {
    const visibility::MethodOptions whole = visibility::complete_options(description, options);
    visibility::MethodOptions alike;
    for (const char* key : {"size", "depth", "rasteriser", "fit", "body", "snap"}) alike[key] = whole.at(key);
    self = make_backproject(device, alike);
  }
  return std::make_unique<SoftShadowMap>(device, map, settings, std::move(self));
}

}  // namespace penumbra::maps
