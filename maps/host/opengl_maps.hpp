#pragma once

#include "maps/host/map_view.shared.h"
#include "render/opengl/raster_pass.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
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

  /// Corners, three a triangle, of one more batch. `places`: of casters with holes what HoleSurfaces says of each
  /// corner, else empty.
  void add(std::span<const glm::vec3> corners, std::span<const std::uint32_t> places = {});
  /// Takes HoleSurfaces::words for batches with holes.
  void set_surfaces(std::span<const std::uint32_t> words);
  /// Drops all batches.
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
  struct Passes {
    render::opengl::RasterPass nearest, behind, farthest;
  };
  struct Batch {
    render::opengl::Buffer corners;
    std::optional<render::opengl::Buffer> places;
  };
  Passes solid_;
  std::optional<Passes> holes_;  // of casters with holes
  render::opengl::DepthTarget target_;
  render::opengl::Buffer previous_;
  std::optional<render::opengl::Buffer> surfaces_;
  std::vector<Batch> batches_;
};

}  // namespace penumbra::maps
