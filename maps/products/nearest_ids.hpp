// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/holes.hpp"
#include "maps/host/map_method.hpp"
#include "maps/products/nearest_ids.shared.h"
#include "render/opengl/raster_pass.hpp"
#include "render/raster_pass.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace penumbra::maps {

/// Property of a triangle compared with the receiver's by a look-up.
enum class IdsOf : std::uint8_t { planes, objects };

/// Caster stored in a texel of the maps of a light's centre: for each texel of the nearest layer the triangle's rank
/// (visibility::ranks), gpu::kNoId for an empty texel. If there are several surfaces at one depth (within 2⁻²⁰, as for
/// layers), the smallest rank is stored. Followed by the values compared by a look-up: for each rank the index of its
/// plane, or of its object.
class NearestIds final : public MapProduct {
 public:
  explicit NearestIds(const render::Device& device, Rasteriser rasteriser = Rasteriser::vulkan,
                      IdsOf compared = IdsOf::planes);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *ids_; }
  [[nodiscard]] std::vector<render::BufferReference> buffers() const override { return {*ids_, *compared_numbers_}; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  /// Triangles that fit into one storage buffer of the rasteriser.
  struct Casters {
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> ids;
    std::vector<std::uint32_t> places;  ///< of casters with holes (HoleSurfaces::add_corners), else empty
  };
  template <typename Pass>
  struct PassPair {
    Pass solid, holes;
  };
  using Passes = PassPair<render::RasterPass>;
  using OpenGlPasses = PassPair<render::opengl::RasterPass>;
  void draw(render::Commands& commands, const MapSet& maps, const std::vector<gpu::IdsPush>& faces,
            const std::vector<Casters>& casters);
  void draw_by_opengl(const MapSet& maps, const std::vector<gpu::IdsPush>& faces, const std::vector<Casters>& casters,
                      const HoleSurfaces& surfaces) const;

  struct Uploaded {
    render::Buffer corners, ids;
    std::optional<render::Buffer> places;
    std::uint32_t vertices;
  };
  const render::Device* device_;
  IdsOf compared_;
  std::optional<Passes> passes_;               // used with Vulkan
  std::optional<OpenGlPasses> opengl_passes_;  // used with OpenGL
  std::optional<render::Buffer> surfaces_;     // HoleSurfaces::words
  std::vector<Uploaded> uploaded_;
  std::unique_ptr<render::Buffer> ids_, compared_numbers_;
};

}  // namespace penumbra::maps
