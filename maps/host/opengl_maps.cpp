// SPDX-License-Identifier: Apache-2.0
// Draws depth maps by OpenGL, with the same shaders as Vulkan.

#include "maps/host/opengl_maps.hpp"

#include "maps/host/caster.frag.glsl.hpp"
#include "maps/host/caster.vert.glsl.hpp"
#include "maps/host/caster_holes.frag.glsl.hpp"
#include "maps/host/caster_holes.vert.glsl.hpp"
#include "maps/host/peel.frag.glsl.hpp"
#include "maps/host/peel_holes.frag.glsl.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::maps {

// A block of OpenGL aligns the member after a struct to the next multiple of 16 bytes.
static_assert(sizeof(gpu::CasterPush) % 16 == 0 && offsetof(gpu::PeelPush, previous) == sizeof(gpu::CasterPush));

namespace {

render::opengl::RasterPassOptions opengl_options(std::string name, std::string_view vertex, std::string_view fragment,
                                                 bool keep_greater = false) {
  return {.name = std::move(name), .vertex = vertex, .fragment = fragment, .depth = true, .keep_greater = keep_greater};
}

}  // namespace

OpenGlMaps::OpenGlMaps(const render::opengl::Context& context, std::uint32_t size)
    : context_(&context),
      size_(size),
      solid_{{context, opengl_options("render maps", shaders::kCasterVertText, shaders::kCasterFragText)},
             {context, opengl_options("peel maps", shaders::kCasterVertText, shaders::kPeelFragText)},
             {context, opengl_options("render farthest", shaders::kCasterVertText, shaders::kCasterFragText, true)}},
      target_(context, "shadow map", size, size),
      previous_(context, "layer before", sizeof(float)) {}

void OpenGlMaps::add(std::span<const glm::vec3> corners, std::span<const std::uint32_t> places) {
  Batch& batch = batches_.emplace_back(
      Batch{render::opengl::Buffer(*context_, "map casters", corners.size_bytes()), std::nullopt});
  batch.corners.write<glm::vec3>(corners);
  if (places.empty()) return;
  batch.places.emplace(*context_, "places of casters", places.size_bytes());
  batch.places->write<std::uint32_t>(places);
}

void OpenGlMaps::set_surfaces(std::span<const std::uint32_t> words) {
  surfaces_.emplace(*context_, "surfaces with holes", words.size_bytes());
  surfaces_->write<std::uint32_t>(words);
  if (holes_) return;
  const auto& vertex = shaders::kCasterHolesVertText;
  const auto& fragment = shaders::kCasterHolesFragText;
  holes_.emplace(Passes{{*context_, opengl_options("render maps with holes", vertex, fragment)},
                        {*context_, opengl_options("peel maps with holes", vertex, shaders::kPeelHolesFragText)},
                        {*context_, opengl_options("render farthest with holes", vertex, fragment, true)}});
}

void OpenGlMaps::set_previous(std::span<const float> depths) {
  if (previous_.bytes() < depths.size_bytes()) {
    previous_ = render::opengl::Buffer(*context_, "layer before", depths.size_bytes());
  }
  previous_.write<float>(depths);
}

void OpenGlMaps::draw(MapLayer layer, const gpu::CasterPush& face, const Triangles& triangles) const {
  gpu::PeelPush push{face, 0, size_};
  push.face.first_vertex = 3 * triangles.first;
  const render::opengl::RasterPass::Draw draw{
      .width = size_, .height = size_, .vertices = 3 * triangles.count, .depth = &target_, .clear = triangles.clear};
  const auto& [corners, places] = batches_.at(triangles.batch);
  if (places) {
    if (layer == MapLayer::behind) return holes_->behind.draw(push, {corners, *places, *surfaces_, previous_}, draw);
    const auto& pass = layer == MapLayer::nearest ? holes_->nearest : holes_->farthest;
    return pass.draw(push.face, {corners, *places, *surfaces_}, draw);
  }
  switch (layer) {
    case MapLayer::nearest:
      return solid_.nearest.draw(push.face, {corners}, draw);
    case MapLayer::behind:
      return solid_.behind.draw(push, {corners, previous_}, draw);
    case MapLayer::farthest:
      return solid_.farthest.draw(push.face, {corners}, draw);
  }
}

}  // namespace penumbra::maps
