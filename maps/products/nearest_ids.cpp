// Hourcade and Nicolas 1985, "Algorithms for antialiased cast shadows": a map that says who is nearest, and not only
// how near. Departure: numbers are triangles' ranks, which do not depend on the order of triangles.

#include "maps/products/nearest_ids.hpp"

#include "maps/host/map_fit.hpp"
#include "maps/products/nearest_ids.frag.glsl.hpp"
#include "maps/products/nearest_ids.frag.spv.hpp"
#include "maps/products/nearest_ids.vert.glsl.hpp"
#include "maps/products/nearest_ids.vert.spv.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace penumbra::maps {

// A block of OpenGL lays out what follows a struct on the next multiple of 16 bytes.
static_assert(offsetof(gpu::IdsPush, size) == sizeof(gpu::CasterPush));

NearestIds::NearestIds(const render::Device& device, Rasteriser rasteriser, IdsOf compared)
    : device_(&device), compared_(compared) {
  if (rasteriser == Rasteriser::opengl) {
    opengl_pass_.emplace(device.opengl(), render::opengl::RasterPassOptions{.name = "nearest ids",
                                                                            .vertex = shaders::kNearestIdsVertText,
                                                                            .fragment = shaders::kNearestIdsFragText});
  } else {
    pass_.emplace(device, render::RasterPassOptions{.name = "nearest ids",
                                                    .vertex = shaders::kNearestIdsVert,
                                                    .fragment = shaders::kNearestIdsFrag,
                                                    .push_bytes = sizeof(gpu::IdsPush),
                                                    .constants = {}});
  }
}

void NearestIds::record(render::Commands& commands, const MapSet& maps) {
  const std::vector<std::uint32_t> ranks = visibility::ranks(maps.scene);
  std::vector<std::uint32_t> numbers(maps.scene.triangles.size() + 1, gpu::kNoId);
  const std::uint64_t room =
      opengl_pass_ ? device_->opengl().info().max_storage_block : device_->limits().max_storage_buffer_range;
  const std::size_t most = room / (3 * sizeof(glm::vec3));
  std::vector<Casters> casters;
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    numbers[ranks[i]] = compared_ == IdsOf::objects ? maps.scene.object[i] : maps.scene.plane[i];
    if (maps.scene.casts_shadow[i] == 0 || maps.scene.emits[i] == maps.light.index) continue;
    if (casters.empty() || casters.back().ids.size() == most) casters.emplace_back();
    casters.back().ids.push_back(ranks[i]);
    for (const glm::vec3& corner : maps.scene.corners(i)) casters.back().corners.push_back(corner);
  }
  render::grow(*device_, compared_numbers_, "numbers of ids", numbers.size() * sizeof(std::uint32_t));
  compared_numbers_->write<std::uint32_t>(numbers);
  const std::uint64_t texels = std::uint64_t{maps.size} * maps.size;
  render::grow(*device_, ids_, "nearest ids", std::max(maps.faces, 1U) * texels * sizeof(std::uint32_t));

  gpu::LightView view{};
  maps.views.read<gpu::LightView>(std::span(&view, 1));
  std::vector<gpu::IdsPush> faces;
  for (std::uint32_t face = 0; face < maps.faces; ++face) {
    faces.push_back({face_push(view, maps.basis, face), maps.size, static_cast<std::uint32_t>(face * texels)});
  }
  if (opengl_pass_) {
    commands.host_pass("nearest ids (OpenGL)", [&] { draw_by_opengl(maps, faces, casters); });
  } else {
    draw(commands, maps, faces, casters);
  }
}

void NearestIds::draw(render::Commands& commands, const MapSet& maps, const std::vector<gpu::IdsPush>& faces,
                      const std::vector<Casters>& casters) {
  commands.fill(*ids_, gpu::kNoId);
  uploaded_.clear();
  for (const Casters& batch : casters) {
    uploaded_.push_back({render::make_buffer<glm::vec3>(*device_, "casters of ids", batch.corners),
                         render::make_buffer<std::uint32_t>(*device_, "their ids", batch.ids),
                         static_cast<std::uint32_t>(batch.corners.size())});
  }
  for (const gpu::IdsPush& push : faces) {
    for (const Uploaded& batch : uploaded_) {
      pass_->record(commands, push, {batch.corners, batch.ids, maps.depths, *ids_},
                    {.width = maps.size, .height = maps.size, .vertices = batch.vertices});
    }
  }
}

void NearestIds::draw_by_opengl(const MapSet& maps, const std::vector<gpu::IdsPush>& faces,
                                const std::vector<Casters>& casters) const {
  const render::opengl::Context& context = device_->opengl();
  const std::size_t texels = std::size_t{std::max(maps.faces, 1U)} * maps.size * maps.size;
  std::vector<float> depths(texels);
  maps.depths.read<float>(depths);
  const render::opengl::Buffer nearest(context, "depths", texels * sizeof(float)),
      found(context, "nearest ids", texels * sizeof(std::uint32_t));
  nearest.write<float>(depths);
  std::vector<std::uint32_t> ids(texels, gpu::kNoId);
  found.write<std::uint32_t>(ids);
  for (const Casters& batch : casters) {
    const render::opengl::Buffer corners(context, "casters of ids", batch.corners.size() * sizeof(glm::vec3)),
        numbers(context, "their ids", batch.ids.size() * sizeof(std::uint32_t));
    corners.write<glm::vec3>(batch.corners);
    numbers.write<std::uint32_t>(batch.ids);
    for (const gpu::IdsPush& push : faces) {
      opengl_pass_->draw(
          push, {corners, numbers, nearest, found},
          {.width = maps.size, .height = maps.size, .vertices = static_cast<std::uint32_t>(batch.corners.size())});
    }
  }
  found.read<std::uint32_t>(ids);
  ids_->write<std::uint32_t>(ids);
}

std::uint64_t NearestIds::memory_bytes() const {
  const auto add = [](std::uint64_t sum, const Uploaded& batch) {
    return sum + batch.corners.bytes() + batch.ids.bytes();
  };
  return std::accumulate(uploaded_.begin(), uploaded_.end(),
                         (ids_ ? ids_->bytes() : 0) + (compared_numbers_ ? compared_numbers_->bytes() : 0), add);
}

}  // namespace penumbra::maps
