// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_view.shared.h"
#include "render/opengl/raster_pass.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Rasteriser of the maps: the device, or OpenGL (docs/rasterisers.md).
enum class Rasteriser : std::uint8_t { vulkan, opengl };

/// Surface of a texel stored by a map.
enum class MapLayer : std::uint8_t { nearest, behind, farthest };

/// Face of CasterMaps, drawn by OpenGL with the device's own shaders and read back.
class OpenGlMaps {
 public:
  /// Makes maps with `size` texels on a side. Throws ResourceError if OpenGL's images cannot have as many.
  OpenGlMaps(const render::opengl::Context& context, std::uint32_t size);

  /// Adds a batch of corners, three for each triangle. `places`: for casters with holes, the data of each corner from
  /// HoleSurfaces, else empty.
  void add(std::span<const glm::vec3> corners, std::span<const std::uint32_t> places = {});
  /// Sets HoleSurfaces::words for batches with holes.
  void set_surfaces(std::span<const std::uint32_t> words);
  /// Drops all batches.
  void forget() { batches_.clear(); }

  /// Sets the previous layer for MapLayer::behind: size² depths.
  void set_previous(std::span<const float> depths);
  /// Triangles first … first + count − 1 of a batch, drawn over the current contents or, with `clear`, over an empty
  /// map.
  struct Triangles {
    std::size_t batch;
    std::uint32_t first, count;
    bool clear;
  };
  void draw(MapLayer layer, const gpu::CasterPush& face, const Triangles& triangles) const;
  /// Reads size² depths, in Vulkan's form.
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
  std::optional<Passes> holes_;  // for casters with holes
  render::opengl::DepthTarget target_;
  render::opengl::Buffer previous_;
  std::optional<render::opengl::Buffer> surfaces_;
  std::vector<Batch> batches_;
};

}  // namespace penumbra::maps
