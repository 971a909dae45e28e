// SPDX-License-Identifier: Apache-2.0
// Draws a map of identities of the nearest surfaces: Hourcade and Nicolas 1985, "Algorithms for antialiased cast
// shadows". Departure: identities are ranks of triangles, which do not depend on the order of triangles.

#include "maps/products/nearest_ids.hpp"

#include "maps/host/map_fit.hpp"
#include "maps/products/nearest_ids.frag.glsl.hpp"
#include "maps/products/nearest_ids.frag.spv.hpp"
#include "maps/products/nearest_ids.vert.glsl.hpp"
#include "maps/products/nearest_ids.vert.spv.hpp"
#include "maps/products/nearest_ids_holes.frag.glsl.hpp"
#include "maps/products/nearest_ids_holes.frag.spv.hpp"
#include "maps/products/nearest_ids_holes.vert.glsl.hpp"
#include "maps/products/nearest_ids_holes.vert.spv.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace penumbra::maps {

// A block of OpenGL aligns the member after a struct to the next multiple of 16 bytes.
static_assert(offsetof(gpu::IdsPush, size) == sizeof(gpu::CasterPush));

NearestIds::NearestIds(const render::Device& device, Rasteriser rasteriser, IdsOf compared)
    : device_(&device), compared_(compared) {
  if (rasteriser == Rasteriser::opengl) {
    opengl_passes_.emplace(OpenGlPasses{
        {device.opengl(),
         {.name = "nearest ids", .vertex = shaders::kNearestIdsVertText, .fragment = shaders::kNearestIdsFragText}},
        {device.opengl(),
         {.name = "nearest ids with holes",
          .vertex = shaders::kNearestIdsHolesVertText,
          .fragment = shaders::kNearestIdsHolesFragText}}});
  } else {
    passes_.emplace(Passes{{device,
                            {.name = "nearest ids",
                             .vertex = shaders::kNearestIdsVert,
                             .fragment = shaders::kNearestIdsFrag,
                             .push_bytes = sizeof(gpu::IdsPush)}},
                           {device,
                            {.name = "nearest ids with holes",
                             .vertex = shaders::kNearestIdsHolesVert,
                             .fragment = shaders::kNearestIdsHolesFrag,
                             .push_bytes = sizeof(gpu::IdsPush)}}});
  }
}

void NearestIds::record(render::Commands& commands, const MapSet& maps) {
  const std::vector<std::uint32_t> ranks = visibility::ranks(maps.scene);
  std::vector<std::uint32_t> numbers(maps.scene.triangles.size() + 1, gpu::kNoId);
  const std::uint64_t room =
      opengl_passes_ ? device_->opengl().info().max_storage_block : device_->limits().max_storage_buffer_range;
  const std::size_t most = room / (3 * gpu::kPlaceWords * sizeof(std::uint32_t));
  const HoleSurfaces surfaces(maps.scene);
  std::vector<Casters> solid, holed;
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    numbers[ranks[i]] = compared_ == IdsOf::objects ? maps.scene.object[i] : maps.scene.plane[i];
    if (maps.scene.casts_shadow[i] == 0 || maps.scene.emits[i] == maps.light.index) continue;
    std::vector<Casters>& casters = has_holes(maps.scene, i) ? holed : solid;
    if (casters.empty() || casters.back().ids.size() == most) casters.emplace_back();
    casters.back().ids.push_back(ranks[i]);
    for (const glm::vec3& corner : maps.scene.corners(i)) casters.back().corners.push_back(corner);
    if (&casters == &holed) surfaces.add_corners(i, casters.back().places);
  }
  solid.insert(solid.end(), holed.begin(), holed.end());
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
  if (opengl_passes_) {
    commands.host_pass("nearest ids (OpenGL)", [&] { draw_by_opengl(maps, faces, solid, surfaces); });
  } else {
    surfaces_ = render::make_buffer<std::uint32_t>(*device_, "surfaces with holes", surfaces.words());
    draw(commands, maps, faces, solid);
  }
}

void NearestIds::draw(render::Commands& commands, const MapSet& maps, const std::vector<gpu::IdsPush>& faces,
                      const std::vector<Casters>& casters) {
  commands.fill(*ids_, gpu::kNoId);
  uploaded_.clear();
  for (const Casters& batch : casters) {
    uploaded_.push_back({render::make_buffer<glm::vec3>(*device_, "casters of ids", batch.corners),
                         render::make_buffer<std::uint32_t>(*device_, "their ids", batch.ids),
                         {},
                         static_cast<std::uint32_t>(batch.corners.size())});
    if (batch.places.empty()) continue;
    uploaded_.back().places = render::make_buffer<std::uint32_t>(*device_, "places of casters", batch.places);
  }
  for (const gpu::IdsPush& push : faces) {
    for (const Uploaded& batch : uploaded_) {
      const render::RasterPass::Draw draw{.width = maps.size, .height = maps.size, .vertices = batch.vertices};
      if (batch.places) {
        passes_->holes.record(commands, push, {batch.corners, *batch.places, *surfaces_, batch.ids, maps.depths, *ids_},
                              draw);
      } else {
        passes_->solid.record(commands, push, {batch.corners, batch.ids, maps.depths, *ids_}, draw);
      }
    }
  }
}

void NearestIds::draw_by_opengl(const MapSet& maps, const std::vector<gpu::IdsPush>& faces,
                                const std::vector<Casters>& casters, const HoleSurfaces& surfaces) const {
  const render::opengl::Context& context = device_->opengl();
  const std::size_t texels = std::size_t{std::max(maps.faces, 1U)} * maps.size * maps.size;
  std::vector<float> depths(texels);
  maps.depths.read<float>(depths);
  const render::opengl::Buffer nearest(context, "depths", texels * sizeof(float)),
      found(context, "nearest ids", texels * sizeof(std::uint32_t));
  nearest.write<float>(depths);
  std::vector<std::uint32_t> ids(texels, gpu::kNoId);
  found.write<std::uint32_t>(ids);
  const render::opengl::Buffer words(context, "surfaces with holes", std::span(surfaces.words()).size_bytes());
  words.write<std::uint32_t>(surfaces.words());
  for (const Casters& batch : casters) {
    const render::opengl::Buffer corners(context, "casters of ids", batch.corners.size() * sizeof(glm::vec3)),
        numbers(context, "their ids", batch.ids.size() * sizeof(std::uint32_t));
    corners.write<glm::vec3>(batch.corners);
    numbers.write<std::uint32_t>(batch.ids);
    const render::opengl::RasterPass::Draw draw{
        .width = maps.size, .height = maps.size, .vertices = static_cast<std::uint32_t>(batch.corners.size())};
    if (batch.places.empty()) {
      for (const gpu::IdsPush& push : faces) opengl_passes_->solid.draw(push, {corners, numbers, nearest, found}, draw);
      continue;
    }
    const render::opengl::Buffer places(context, "places of casters", std::span(batch.places).size_bytes());
    places.write<std::uint32_t>(batch.places);
    for (const gpu::IdsPush& push : faces)
      opengl_passes_->holes.draw(push, {corners, places, words, numbers, nearest, found}, draw);
  }
  found.read<std::uint32_t>(ids);
  ids_->write<std::uint32_t>(ids);
}

std::uint64_t NearestIds::memory_bytes() const {
  const auto add = [](std::uint64_t sum, const Uploaded& batch) {
    return sum + batch.corners.bytes() + batch.ids.bytes() + (batch.places ? batch.places->bytes() : 0);
  };
  return std::accumulate(uploaded_.begin(), uploaded_.end(),
                         (ids_ ? ids_->bytes() : 0) + (compared_numbers_ ? compared_numbers_->bytes() : 0), add);
}

}  // namespace penumbra::maps
