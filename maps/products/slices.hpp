// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/holes.hpp"
#include "maps/host/map_method.hpp"
#include "maps/products/slices.shared.h"
#include "render/opengl/raster_pass.hpp"
#include "render/compute_pass.hpp"
#include "render/raster_pass.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace penumbra::maps {

enum class SliceRule : std::uint8_t {
  /// Equally thick slices from the nearest caster to the deepest, or to the deepest receiver if that is nearer.
  /// Surfaces in a slice are moved to its far plane (Eisemann and Décoret 2006).
  equal,
  /// One slice, with all casters except the ground (ground_of), at their mean height (Soler and Sillion 1998).
  one_plane,
};

/// Returns the object that receives but does not cast shadow in a method that separates the two. If some receiver casts
/// no shadow, there is no such object; else it is the object whose receiving triangles, seen from the light's plane,
/// are largest. kNoObject if there is none.
inline constexpr std::uint32_t kNoObject = 0xffffffffU;
std::uint32_t ground_of(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis);

/// Returns the planes of `count` slices (1 … 32; one_plane: 1).
gpu::SlicePlanes slice_planes(const MapSet& maps, SliceRule rule, std::uint32_t count);

struct SliceOptions {
  SliceRule rule = SliceRule::equal;
  std::uint32_t count = 1;
  Rasteriser rasteriser = Rasteriser::vulkan;
  /// Depth by which the nearest of a texel's surfaces is sorted: the depth at which its shadow begins
  /// (shadow_depths.glsl); surfaces behind it are unchanged. The maps then have two layers.
  DepthUse depth = DepthUse::first;
  double bias = 0;  ///< number of texels by which the look-up reduces receivers' heights
};

/// Casters sorted into slices parallel to the light: for each texel of the maps of a light's centre a word whose bit k
/// is set if a surface in slice k lies in its direction. Surfaces hidden from the light's centre count, too.
class Slices final : public MapProduct {
 public:
  Slices(const render::Device& device, const SliceOptions& options);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *bits_; }  ///< the words
  /// Returns the buffers of a look-up: the planes alone.
  [[nodiscard]] std::vector<render::BufferReference> buffers() const override { return {planes_}; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  struct Casters {
    std::optional<render::Buffer> corners;
    std::optional<render::opengl::Buffer> opengl_corners;
    std::optional<render::Buffer> places;  ///< of casters with holes (HoleSurfaces::add_corners)
    std::optional<render::opengl::Buffer> opengl_places;
    std::uint32_t vertices;
    bool holes;
  };
  template <typename Pass>
  struct PassPair {
    Pass solid, holes;
  };
  using Passes = PassPair<render::RasterPass>;
  using OpenGlPasses = PassPair<render::opengl::RasterPass>;
  void upload(const MapSet& maps);
  /// Uploads the casters, except the ground, with or without holes.
  void upload_casters(const MapSet& maps, std::uint32_t ground, const HoleSurfaces* surfaces);
  /// Returns all faces as push constants of slices.frag; `first` is the index of a face's first texel among the words.
  [[nodiscard]] std::vector<gpu::SlicesPush> faces_of(const MapSet& maps) const;
  void draw_by_opengl(const MapSet& maps, const gpu::SlicePlanes& planes) const;
  /// Moves the nearest surfaces to the slices where their shadows begin.
  void move_nearest(render::Commands& commands, const MapSet& maps);

  const render::Device* device_;
  SliceOptions options_;
  std::optional<Passes> passes_;               // used with Vulkan
  std::optional<OpenGlPasses> opengl_passes_;  // used with OpenGL
  std::optional<render::ComputePass> moved_;
  std::optional<CasterMaps> blocker_maps_;          ///< maps of all casters except the ground
  std::unique_ptr<render::Buffer> blocker_depths_;  ///< depths of blocker_maps_, in two layers
  render::Buffer planes_;
  std::vector<Casters> casters_;
  std::optional<render::Buffer> surfaces_;  // HoleSurfaces::words
  std::optional<render::opengl::Buffer> opengl_surfaces_;
  std::unique_ptr<render::Buffer> bits_;
};

}  // namespace penumbra::maps
