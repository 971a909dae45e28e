#include "maps/center_map.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::maps {

std::vector<visibility::LightKind> planar_lights() {
  return {visibility::LightKind::rectangle, visibility::LightKind::disk, visibility::LightKind::polygon};
}

CenterMapMethod::CenterMapMethod(const render::Device& device, visibility::MethodDescription description,
                                 const visibility::MethodOptions& options)
    : device_(&device),
      description_(std::move(description)),
      options_((visibility::check_options(description_, options), parse_map_options(device, description_, options))),
      casters_(device, options_.size) {}

void CenterMapMethod::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  casters_.upload(scene);
}

void CenterMapMethod::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  const LightFrame frame = frame_of(light);
  const glm::vec3 center(frame.center);
  const FittedViews fitted = fit_views(*scene_, light, frame, std::span(&center, 1), options_.size);
  check_faces_fit(*device_, options_.size, fitted.faces);

  const std::uint64_t face_bytes = std::uint64_t{options_.size} * options_.size * sizeof(float);
  render::grow(*device_, views_, "map views", sizeof(gpu::LightView));
  views_->write<gpu::LightView>(fitted.views);
  render::grow(*device_, depths_, "map depths", face_bytes * std::max(fitted.faces, 1u));
  render::Commands commands(*device_);
  casters_.record(commands, fitted.views.front(), frame, light.index, *depths_, 0);
  map_rendered(commands, {*views_, *depths_}, fitted.faces, light, frame);
  times_.add(commands.submit());

  push_ = {.frame = frame.rounded(),
           .bias = static_cast<float>(options_.bias),
           .size = options_.size,
           .two_sided = light.two_sided ? 1u : 0u,
           .first_receiver = 0,
           .receiver_count = 0,
           .first_result = 0};
  counters_ = {{"maps", 1}, {"mapFaces", fitted.faces}, {"casters", casters_.caster_count()}};
}

void CenterMapMethod::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_view before prepare_mesh", description_.name);
  receivers_.upload(*device_, *scene_, samples);
}

std::uint32_t CenterMapMethod::max_tile_rows() const {
  return receivers_.max_rows(*device_, sizeof(float));
}

void CenterMapMethod::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(depths_ != nullptr, "{}: evaluate before prepare_light", description_.name);
  tile_pixels_ = tile.row_count * receivers_.width();
  if (tile_pixels_ == 0) return;
  render::grow(*device_, visibility_, "map visibility", std::uint64_t{tile_pixels_} * sizeof(float));
  render::Commands commands(*device_);
  for (const Receivers::Part& part : receivers_.parts(tile)) {
    gpu::LookupPush push = push_;
    push.first_receiver = part.first_receiver;
    push.receiver_count = part.count;
    push.first_result = part.first_result;
    record_lookup(commands, push, part, {*views_, *depths_}, *visibility_);
  }
  times_.add(commands.submit());
}

void CenterMapMethod::read_visibility(std::span<float> visibility) {
  PENUMBRA_ASSERT(visibility.size() == tile_pixels_, "{} values for a tile of {} pixels", visibility.size(),
                  tile_pixels_);
  if (!visibility.empty()) visibility_->read(visibility);
}

std::uint64_t CenterMapMethod::memory_bytes() const {
  std::uint64_t bytes = casters_.memory_bytes() + receivers_.memory_bytes() + own_memory_bytes();
  for (const auto* buffer : {&views_, &depths_, &visibility_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
