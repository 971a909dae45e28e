#include "maps/host/caster_maps.hpp"

#include "base/error.hpp"
#include "maps/host/caster.frag.spv.hpp"
#include "maps/host/caster.vert.spv.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/peel.frag.spv.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

namespace penumbra::maps {

namespace {

render::RasterPassOptions pass_options(std::string name, render::DepthCompare compare) {
  return {.name = std::move(name),
          .vertex = shaders::kCasterVert,
          .fragment = shaders::kCasterFrag,
          .push_bytes = sizeof(gpu::CasterPush),
          .constants = {},
          .depth = true,
          .compare = compare};
}

render::RasterPassOptions behind_options() {
  render::RasterPassOptions options = pass_options("peel maps", render::DepthCompare::less);
  options.fragment = shaders::kPeelFrag;
  options.push_bytes = sizeof(gpu::PeelPush);
  return options;
}

}  // namespace

CasterMaps::CasterMaps(const render::Device& device, std::uint32_t size)
    : device_(&device),
      size_(size),
      pass_(device, pass_options("render maps", render::DepthCompare::less)),
      behind_(device, behind_options()),
      farthest_(device, pass_options("render farthest", render::DepthCompare::greater)),
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

template <typename PushOf>
void CasterMaps::record_faces(render::Commands& commands, const render::RasterPass& pass, const gpu::LightView& view,
                              const LightBasis& basis, std::int32_t light_index, const render::Buffer& maps,
                              std::uint64_t first_face, float nothing, const PushOf& push_of) const {
  const std::uint32_t faces = view.side[0].face_count + view.side[1].face_count;
  const std::uint64_t face_bytes = std::uint64_t{size_} * size_ * sizeof(float);
  for (std::uint32_t face = 0; face < faces; ++face) {
    gpu::CasterPush push = face_push(view, basis, face);
    bool clear = true;
    for (const Batch& batch : batches_) {
      for (const Range& range : ranges(batch, light_index)) {
        push.first_vertex = 3 * range.first;
        const auto words = push_of(push, face);
        std::vector<render::BufferReference> buffers{batch.corners};
        if constexpr (sizeof(words) != sizeof(push)) buffers.emplace_back(maps);
        pass.record(commands, std::as_bytes(std::span(&words, 1)), buffers,
                    {.width = size_, .height = size_, .vertices = 3 * range.count, .depth = &target_, .clear = clear});
        clear = false;
      }
    }
    if (clear) {  // nothing casts shadow: the map is empty
      commands.fill(maps, std::bit_cast<std::uint32_t>(nothing), (first_face + face) * face_bytes, face_bytes);
    } else {
      target_.copy_to(commands, maps, (first_face + face) * face_bytes);
    }
  }
}

void CasterMaps::record(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                        std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const {
  record_faces(commands, pass_, view, basis, light_index, maps, first_face, 1.0F,
               [](const gpu::CasterPush& push, std::uint32_t) { return push; });
}

void CasterMaps::record_behind(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                               std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face,
                               std::uint64_t previous_face) const {
  const auto push_of = [&](const gpu::CasterPush& push, std::uint32_t face) {
    return gpu::PeelPush{push, static_cast<std::uint32_t>((previous_face + face) * size_ * size_), size_};
  };
  record_faces(commands, behind_, view, basis, light_index, maps, first_face, 1.0F, push_of);
}

void CasterMaps::record_farthest(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                                 std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const {
  record_faces(commands, farthest_, view, basis, light_index, maps, first_face, 0.0F,
               [](const gpu::CasterPush& push, std::uint32_t) { return push; });
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
