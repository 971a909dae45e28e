// SPDX-License-Identifier: Apache-2.0
// Draws a second map of penumbrae beside silhouettes (Wyman and Hansen 2003, Chan and Durand 2003).

#include "maps/single_shadow/outer_map.hpp"

#include "base/error.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/single_shadow/outer_map.frag.glsl.hpp"
#include "maps/single_shadow/outer_map.frag.spv.hpp"
#include "maps/single_shadow/outer_map.vert.glsl.hpp"
#include "maps/single_shadow/outer_map.vert.spv.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace penumbra::maps {
namespace {

constexpr std::array<std::uint32_t, 2> kNothing{0x3f800000U, 0x7f800000U};  // 1, and infinity

/// Returns the push constants of a face of one side of a view, in the light's basis with z from its plane.
gpu::OuterPush outer_push(const gpu::LightView& view, std::uint32_t side, std::uint32_t face, std::uint32_t size) {
  // face_of returns axes in the world; given the world's own axes as basis, it returns axes in the light's basis.
  gpu::LightView turned = view;
  turned.point = glm::vec3(0);
  LightBasis axes;
  axes.u = {1, 0, 0};
  axes.v = {0, 1, 0};
  axes.n = {0, 0, 1};
  const gpu::CasterPush rows = face_push(turned, axes, view.side[side].first_face + face);
  const Face seen = face_of(turned, axes, view.side[side].first_face + face);
  const glm::vec3 mirror(1, 1, side == 0 ? 1 : -1);
  gpu::OuterPush push{};
  push.row_x = rows.row_x * mirror;
  push.row_y = rows.row_y * mirror;
  push.row_w = rows.row_w * mirror;
  push.near = rows.near;
  push.far = view.far;
  push.lower = seen.lower;
  push.texel = (seen.upper - seen.lower) / static_cast<double>(size);
  push.size = size;
  push.axis = 2;
  push.sign = 1;
  if (view.side[side].face_count > 1 && face > 0) {
    push.axis = face <= 2 ? 0 : 1;
    push.sign = face == 1 || face == 3 ? 1.0F : -1.0F;
  }
  return push;
}

}  // namespace

OuterMap::OuterMap(const render::Device& device, const Options& options) : device_(&device), options_(options) {
  if (options_.rasteriser == Rasteriser::opengl) {
    opengl_pass_.emplace(device.opengl(), render::opengl::RasterPassOptions{.name = "outer penumbrae",
                                                                            .vertex = shaders::kOuterMapVertText,
                                                                            .fragment = shaders::kOuterMapFragText});
  } else {
    pass_.emplace(device, render::RasterPassOptions{.name = "outer penumbrae",
                                                    .vertex = shaders::kOuterMapVert,
                                                    .fragment = shaders::kOuterMapFrag,
                                                    .push_bytes = sizeof(gpu::OuterPush),
                                                    .constants = {}});
  }
}

void OuterMap::record_surfaces(render::Commands& commands, const MapSet& maps, const gpu::LightView& view) {
  visibility::SceneFloats drawn = maps.scene;
  for (std::size_t i = 0; i < drawn.casts_shadow.size(); ++i) {
    const bool proper = drawn.plane[i] != visibility::SceneFloats::kNoPlane;
    if (proper && drawn.receives_shadow[i] != 0) drawn.casts_shadow[i] = 1;
  }
  if (!surface_maps_) surface_maps_.emplace(*device_, maps.size, options_.rasteriser);
  surface_maps_->upload(drawn);
  surface_maps_->record(commands, view, maps.basis, maps.light.index, *surfaces_, 0);
}

void OuterMap::record(render::Commands& commands, const MapSet& maps) {
  gpu::LightView view{};
  maps.views.read<gpu::LightView>(std::span(&view, 1));
  const std::size_t texels = std::size_t{maps.size} * maps.size * std::max(maps.faces, 1U);
  if (texels * 2 * sizeof(std::uint32_t) > device_->limits().max_storage_buffer_range) {
    throw ResourceError(
        "method option size={}: the outer penumbrae need two words a texel of {} faces, more than one "
        "buffer of {} can hold; take a smaller size",
        maps.size, maps.faces, device_->info().name);
  }
  render::grow(*device_, surfaces_, "surfaces", texels * sizeof(float));
  render::grow(*device_, outer_, "outer penumbrae", texels * 2 * sizeof(std::uint32_t));
  std::vector<std::uint32_t> nothing(texels * 2);
  for (std::size_t i = 0; i < nothing.size(); ++i) nothing[i] = kNothing[i % 2];
  outer_->write<std::uint32_t>(nothing);
  if (maps.faces == 0) return;
  record_surfaces(commands, maps, view);

  // Surfaces nearer to the light's plane are not drawn in its maps either (map_fit.cpp).
  edges_ =
      outer_edges(maps.scene, maps.light, maps.basis, options_.form, std::ldexp(static_cast<double>(view.far), -20));
  double width = half_width(maps.light);
  if (options_.form == OuterForm::smoothies) {
    const double height = edges_.mean_height;
    width = options_.width > 0 ? options_.width : height > 0 ? width / height : 1;
  }
  std::vector<gpu::OuterPush> faces;
  for (std::uint32_t side = 0; side < 2; ++side) {
    for (std::uint32_t face = 0; face < view.side[side].face_count; ++face) {
      gpu::OuterPush push = outer_push(view, side, face, maps.size);
      push.first = (view.side[side].first_face + face) * maps.size * maps.size;
      push.width = static_cast<float>(width);
      push.smoothies = options_.form == OuterForm::smoothies ? 1 : 0;
      faces.push_back(push);
    }
  }
  if (opengl_pass_) {
    commands.host_pass("outer penumbrae (OpenGL)",
                       [this, faces, view, texels] { draw_by_opengl(faces, view, texels); });
  } else {
    draw(commands, maps, faces, view);
  }
}

void OuterMap::draw(render::Commands& commands, const MapSet& maps, const std::vector<gpu::OuterPush>& faces,
                    const gpu::LightView& view) {
  uploaded_.clear();
  for (const auto& side : edges_.sides) {
    const std::vector<gpu::OuterEdge> none(1);
    uploaded_.push_back(render::make_buffer<gpu::OuterEdge>(*device_, "silhouette edges", side.empty() ? none : side));
  }
  for (const gpu::OuterPush& push : faces) {
    const std::uint32_t side = push.first / (maps.size * maps.size) < view.side[0].face_count ? 0 : 1;
    const auto vertices = static_cast<std::uint32_t>(edges_.sides[side].size() * gpu::kOuterVertices);
    if (vertices == 0) continue;
    pass_->record(commands, push, {uploaded_[side], *surfaces_, *outer_},
                  {.width = maps.size, .height = maps.size, .vertices = vertices});
  }
}

void OuterMap::draw_by_opengl(const std::vector<gpu::OuterPush>& faces, const gpu::LightView& view,
                              std::size_t texels) const {
  const render::opengl::Context& context = device_->opengl();
  std::vector<float> depths(texels);
  surfaces_->read<float>(depths);
  std::vector<std::uint32_t> kept(2 * texels);
  outer_->read<std::uint32_t>(kept);
  const render::opengl::Buffer surfaces(context, "surfaces", depths.size() * sizeof(float)),
      outer(context, "outer penumbrae", kept.size() * sizeof(std::uint32_t));
  surfaces.write<float>(depths);
  outer.write<std::uint32_t>(kept);
  for (const gpu::OuterPush& push : faces) {
    const auto& side = edges_.sides[push.first / (push.size * push.size) < view.side[0].face_count ? 0 : 1];
    if (side.empty()) continue;
    const render::opengl::Buffer edges(context, "silhouette edges", side.size() * sizeof(gpu::OuterEdge));
    edges.write<gpu::OuterEdge>(side);
    opengl_pass_->draw(push, {edges, surfaces, outer},
                       {.width = push.size,
                        .height = push.size,
                        .vertices = static_cast<std::uint32_t>(side.size() * gpu::kOuterVertices)});
  }
  outer.read<std::uint32_t>(kept);
  outer_->write<std::uint32_t>(kept);
}

std::uint64_t OuterMap::memory_bytes() const {
  std::uint64_t bytes = surface_maps_ ? surface_maps_->memory_bytes() : 0;
  for (const auto* buffer : {&surfaces_, &outer_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  for (const render::Buffer& buffer : uploaded_) bytes += buffer.bytes();
  return bytes;
}

void OuterMap::add_counters(std::map<std::string, std::uint64_t>& counters) const {
  counters["silhouetteEdges"] = edges_.sides[0].size() + edges_.sides[1].size();
}

}  // namespace penumbra::maps
