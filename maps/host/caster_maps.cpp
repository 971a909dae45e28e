#include "maps/host/caster_maps.hpp"

#include "base/error.hpp"
#include "maps/host/caster.frag.spv.hpp"
#include "maps/host/caster.vert.spv.hpp"
#include "maps/host/map_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace penumbra::maps {

CasterMaps::CasterMaps(const render::Device& device, std::uint32_t size)
    : device_(&device),
      size_(size),
      pass_(device, {.name = "render maps",
                     .vertex = shaders::kCasterVert,
                     .fragment = shaders::kCasterFrag,
                     .push_bytes = sizeof(gpu::CasterPush),
                     .constants = {},
                     .depth = true}),
      target_(device, "shadow map", size, size) {}

void CasterMaps::upload(const visibility::SceneFloats& scene) {
  std::vector<std::uint32_t> casters;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casters.push_back(i);
  }
  std::stable_sort(casters.begin(), casters.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return scene.emits[a] < scene.emits[b]; });
  emits_.resize(casters.size());
  std::transform(casters.begin(), casters.end(), emits_.begin(), [&](std::uint32_t i) { return scene.emits[i]; });

  constexpr std::size_t kCornerBytes = 3 * sizeof(glm::vec3);
  const std::size_t most = device_->limits().max_storage_buffer_range / kCornerBytes;
  batches_.clear();
  for (std::size_t first = 0; first < casters.size(); first += most) {
    const std::size_t count = std::min(most, casters.size() - first);
    std::vector<glm::vec3> corners;
    corners.reserve(3 * count);
    for (const std::uint32_t caster : std::span(casters).subspan(first, count)) {
      for (const glm::vec3& corner : scene.corners(caster)) corners.push_back(corner);
    }
    batches_.push_back({render::make_buffer<glm::vec3>(*device_, "map casters", corners),
                        static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
  }
}

std::vector<CasterMaps::Range> CasterMaps::ranges(const Batch& batch, std::int32_t light_index) const {
  const auto first = emits_.begin() + batch.first, last = first + batch.count;
  const auto [body, rest] = std::equal_range(first, last, light_index);
  std::vector<Range> ranges;
  for (const auto& [from, to] : {std::pair(first, body), std::pair(rest, last)}) {
    if (from != to) ranges.push_back({static_cast<std::uint32_t>(from - first), static_cast<std::uint32_t>(to - from)});
  }
  return ranges;
}

void CasterMaps::record(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                        std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const {
  const std::uint32_t faces = view.side[0].face_count + view.side[1].face_count;
  const std::uint64_t face_bytes = std::uint64_t{size_} * size_ * sizeof(float);
  for (std::uint32_t face = 0; face < faces; ++face) {
    gpu::CasterPush push = face_push(view, basis, face);
    bool clear = true;
    for (const Batch& batch : batches_) {
      for (const Range& range : ranges(batch, light_index)) {
        push.first_vertex = 3 * range.first;
        pass_.record(commands, push, {batch.corners},
                     {.width = size_, .height = size_, .vertices = 3 * range.count, .depth = &target_, .clear = clear});
        clear = false;
      }
    }
    if (clear) {                                  // nothing casts shadow: the map is empty
      const std::uint32_t nothing = 0x3f800000u;  // 1.0f
      commands.fill(maps, nothing, (first_face + face) * face_bytes, face_bytes);
    } else {
      target_.copy_to(commands, maps, (first_face + face) * face_bytes);
    }
  }
}

std::uint64_t CasterMaps::memory_bytes() const {
  const auto add = [](std::uint64_t sum, const Batch& batch) { return sum + batch.corners.bytes(); };
  return std::accumulate(batches_.begin(), batches_.end(), std::uint64_t{size_} * size_ * sizeof(float), add);
}

std::uint64_t faces_per_buffer(const render::Device& device, std::uint32_t size) {
  return device.limits().max_storage_buffer_range / (std::uint64_t{size} * size * sizeof(float));
}

void check_faces_fit(const render::Device& device, std::uint32_t size, std::uint32_t faces) {
  if (faces <= faces_per_buffer(device, size)) return;
  const auto most = std::sqrt(static_cast<double>(device.limits().max_storage_buffer_range) / (sizeof(float) * faces));
  throw ResourceError(
      "method option size={}: this light needs {} maps at once, more than one buffer of {} can hold; take "
      "size={} or less",
      size, faces, device.info().name, static_cast<std::uint32_t>(most));
}

}  // namespace penumbra::maps
