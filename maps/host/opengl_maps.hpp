#pragma once

#include "maps/host/map_view.shared.h"
#include "render/opengl/raster_pass.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Who draws the maps: the device itself, or OpenGL beside it (docs/rasterisers.md).
enum class Rasteriser : std::uint8_t { vulkan, opengl };

/// Which of a texel's surfaces a map holds.
enum class MapLayer : std::uint8_t { nearest, behind, farthest };

/// A face of CasterMaps, drawn by OpenGL with the device's own shaders and read back.
class OpenGlMaps {
 public:
  /// `size`: texels on a side. Throws ResourceError for more than its images can have.
  OpenGlMaps(const render::opengl::Context& context, std::uint32_t size);

  /// Corners, three a triangle, of one more batch; or of none any more.
  void add(std::span<const glm::vec3> corners);
  void forget() { batches_.clear(); }

  /// The layer that MapLayer::behind is behind of: size² depths.
  void set_previous(std::span<const float> depths);
  /// Triangles first … first + count − 1 of a batch, over what is there or over nothing.
  struct Triangles {
    std::size_t batch;
    std::uint32_t first, count;
    bool clear;
  };
  void draw(MapLayer layer, const gpu::CasterPush& face, const Triangles& triangles) const;
  /// size² depths, as Vulkan's.
  void read(std::span<float> depths) const { target_.read(depths); }

 private:
  const render::opengl::Context* context_;
  std::uint32_t size_;
  render::opengl::RasterPass nearest_, behind_, farthest_;
  render::opengl::DepthTarget target_;
  render::opengl::Buffer previous_;
  std::vector<render::opengl::Buffer> batches_;
};

}  // namespace penumbra::maps
