// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/holes.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_view.shared.h"
#include "maps/host/opengl_maps.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/device.hpp"
#include "render/raster_pass.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/pass_times.hpp"
#include "visibility/scene_floats.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Face to draw: as given, or with logarithmic rows.
struct FacePush {
  gpu::CasterPush plain{};
  std::optional<gpu::LogarithmicPush> logarithmic{};
};

/// Renders depth maps of all casters except the body of the light itself: on the device, or by OpenGL, which fills the
/// same buffers. A caster with holes (holes.hpp) is not drawn in its holes.
class CasterMaps {
 public:
  /// Makes a renderer of maps with `size` texels on a side. Throws ResourceError if the rasteriser's images cannot be
  /// as large, and if OpenGL is requested but not available.
  CasterMaps(const render::Device& device, std::uint32_t size, Rasteriser rasteriser = Rasteriser::vulkan);

  /// Sets the polygon offset of the nearest surfaces for all following draws (CasterPush).
  void set_offset(float factor, float units) {
    offset_factor_ = factor;
    offset_units_ = units;
  }
  void upload(const visibility::SceneFloats& scene);
  /// Draws the triangles of `all` in place of uploaded ones, in parts as `all` passes them, by Vulkan. `all` and
  /// `times` must outlive all draws. Such a draw submits the recorded commands whenever its buffer is full, and adds
  /// their times to `times`. Casters have no holes.
  void pass(const visibility::AllTriangles& all, visibility::PassTimes& times);

  /// Records the faces of one light point of the light with index `light_index` and copies them, one after the other,
  /// to `maps`, the first at `first_face` · size² floats.
  void record(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis, std::int32_t light_index,
              const render::Buffer& maps, std::uint64_t first_face) const;
  /// Records the next layer (Everitt 2001, depth peeling): the nearest surface behind the layer whose faces begin at
  /// `previous_face`; in all other respects like record(). Empty texels are 1. Surfaces within a relative 2⁻²⁰ of the
  /// previous layer belong to the previous layer: a surface present twice, in different triangles, differs by rounding.
  void record_behind(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                     std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face,
                     std::uint64_t previous_face) const;
  /// Overloads for faces of any kind; by Vulkan alone.
  void record(render::Commands& commands, std::span<const FacePush> faces, std::int32_t light_index,
              const render::Buffer& maps, std::uint64_t first_face) const;
  void record_behind(render::Commands& commands, std::span<const FacePush> faces, std::int32_t light_index,
                     const render::Buffer& maps, std::uint64_t first_face, std::uint64_t previous_face) const;
  /// Records the farthest surface of each texel; in all other respects like record(). Empty texels are 0.
  void record_farthest(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                       std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const;

  /// Returns the number of uploaded casters, or, after pass(), of those that passed in the last draw.
  [[nodiscard]] std::uint64_t caster_count() const { return all_ != nullptr ? passed_ : emits_.size(); }
  [[nodiscard]] bool have_holes() const { return std::ranges::any_of(batches_, &Batch::holes); }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  /// Triangles that fit into one storage buffer of the rasteriser.
  struct Batch {
    std::optional<render::Buffer> corners;  ///< for Vulkan; OpenGlMaps has separate ones
    std::optional<render::Buffer> places;   ///< of casters with holes, for Vulkan
    std::uint32_t first, count;
    bool holes;
  };
  struct Range {
    std::uint32_t first, count;
  };
  /// Raster passes of Vulkan.
  struct Passes {
    Passes(const render::Device& device, bool holes);
    [[nodiscard]] const render::RasterPass& of(MapLayer layer) const;
    [[nodiscard]] const render::RasterPass& logarithmic_faces(const render::Device& device) const;
    render::RasterPass nearest, behind, farthest;
    mutable std::optional<render::RasterPass> logarithmic;  ///< made on first use
  };
  /// Destination of faces.
  struct Destination {
    const render::Buffer& maps;
    std::uint64_t first_face, previous_face;
  };
  /// Appends casters, all with holes or all without, as batches. `surfaces`: those with holes, else null.
  void add_batches(const visibility::SceneFloats& scene, std::span<const std::uint32_t> casters,
                   const HoleSurfaces* surfaces);
  /// Returns the casters of a batch without the body of the light.
  [[nodiscard]] std::vector<Range> ranges(const Batch& batch, std::int32_t light_index) const;
  [[nodiscard]] gpu::CasterPush offset(gpu::CasterPush push) const;
  /// Records all faces of a light point.
  void record_faces(render::Commands& commands, MapLayer layer, std::span<const FacePush> faces,
                    std::int32_t light_index, const Destination& to) const;
  void record_on_device(render::Commands& commands, MapLayer layer, const FacePush& push, std::int32_t light_index,
                        std::uint32_t face, const Destination& to) const;
  void record_passing(render::Commands& commands, MapLayer layer, const FacePush& push, std::int32_t light_index,
                      std::uint32_t face, const Destination& to) const;
  void draw_by_opengl(MapLayer layer, const gpu::CasterPush& push, std::int32_t light_index, std::uint32_t face,
                      const Destination& to) const;

  const render::Device* device_;
  std::uint32_t size_;
  float offset_factor_ = 0, offset_units_ = 0;
  std::optional<Passes> solid_, holes_;  // used with Vulkan
  std::optional<render::DepthTarget> target_;
  std::optional<render::Buffer> surfaces_;  // HoleSurfaces::words
  std::unique_ptr<OpenGlMaps> opengl_;      // used with OpenGL
  std::vector<Batch> batches_;
  std::vector<std::int32_t> emits_;  // for each uploaded caster, ascending in a batch: a light's body is one range
  const visibility::AllTriangles* all_ = nullptr;  // drawn in place of batches
  visibility::PassTimes* times_ = nullptr;         // times of draws of all_
  mutable std::unique_ptr<render::Buffer> passing_;
  mutable std::uint64_t passed_ = 0;
};

/// Returns the number of faces of size² floats in one storage buffer of this device.
std::uint64_t faces_per_buffer(const render::Device& device, std::uint32_t size);

/// Throws ResourceError, with the largest possible size, if `faces` do not fit into one storage buffer.
void check_faces_fit(const render::Device& device, std::uint32_t size, std::uint32_t faces);

/// Number of faces in one recording: each face takes two passes, and Commands times 256 passes.
inline constexpr std::uint32_t kFacesPerSubmission = 96;

}  // namespace penumbra::maps
