#include "maps/host/opengl_maps.hpp"

#include "maps/host/caster.frag.glsl.hpp"
#include "maps/host/caster.vert.glsl.hpp"
#include "maps/host/peel.frag.glsl.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::maps {

// A block of OpenGL lays out what follows a struct on the next multiple of 16 bytes.
static_assert(sizeof(gpu::CasterPush) % 16 == 0 && offsetof(gpu::PeelPush, previous) == sizeof(gpu::CasterPush));

namespace {

render::opengl::RasterPassOptions opengl_options(std::string name, std::string_view fragment, bool keep_greater) {
  return {.name = std::move(name),
          .vertex = shaders::kCasterVertText,
          .fragment = fragment,
          .depth = true,
          .keep_greater = keep_greater};
}

}  // namespace

OpenGlMaps::OpenGlMaps(const render::opengl::Context& context, std::uint32_t size)
    : context_(&context),
      size_(size),
      nearest_(context, opengl_options("render maps", shaders::kCasterFragText, false)),
      behind_(context, opengl_options("peel maps", shaders::kPeelFragText, false)),
      farthest_(context, opengl_options("render farthest", shaders::kCasterFragText, true)),
      target_(context, "shadow map", size, size),
      previous_(context, "layer before", sizeof(float)) {}

void OpenGlMaps::add(std::span<const glm::vec3> corners) {
  render::opengl::Buffer& batch = batches_.emplace_back(*context_, "map casters", corners.size_bytes());
  batch.write<glm::vec3>(corners);
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
  const render::opengl::Buffer& corners = batches_.at(triangles.batch);
  switch (layer) {
    case MapLayer::nearest:
      return nearest_.draw(push.face, {corners}, draw);
    case MapLayer::behind:
      return behind_.draw(push, {corners, previous_}, draw);
    case MapLayer::farthest:
      return farthest_.draw(push.face, {corners}, draw);
  }
}

}  // namespace penumbra::maps
