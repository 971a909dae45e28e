// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"
#include "volumes/raster/wedge_footprint.hpp"
#include "volumes/raster/wedge_raster.shared.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::volumes {

/// The silhouette edges of one light with their wedges.
struct LightWedges {
  std::vector<VolumeEdge> edges;
  std::vector<Wedge> wedges;  ///< wedges whose source is edge i belong to it, in order (build_wedges)
};
LightWedges wedges_of(const LightVolumes& volumes, const visibility::Light& light, Construction construction);

/// Returns the faces of wedges that may have a receiver on the screen. `center`: the light's centre.
std::vector<gpu::WedgeFace> faces_of(const LightWedges& wedges, const visibility::ViewSamples& samples,
                                     WedgeTests tests, const glm::dvec3& center);

/// Returns the approximate number of pixels that the faces propose: the areas of their footprints.
std::uint64_t fragments_of(std::span<const gpu::WedgeFace> faces);

/// Returns push constants with the duals of a planar light's axes (visibility::LightFrame) around center_of. The fields
/// of the tile are not set.
gpu::WedgePush wedge_push(const visibility::Light& light);

/// Returns whether p is projected to within a sixteenth of a pixel of its pixel's centre. If not, footprints may miss
/// p: rounding has moved it, which next to the camera may be several pixels.
bool appears_in_place(const visibility::PinholeCamera& camera, const glm::vec3& p, std::size_t pixel);

struct WedgeShader {
  std::string name;
  std::span<const std::uint32_t> fragment;
  std::vector<std::uint32_t> constants{};
  std::uint32_t words = 1;  ///< words of sums for each receiver
  bool table = true;        ///< whether the shader reads a table
};

/// Rasterises wedges and adds up the fragment shader's result for each wedge at each receiver: in integers, so the
/// order is irrelevant.
class WedgeRaster {
 public:
  WedgeRaster(const render::Device& device, const WedgeShader& shader);
  ~WedgeRaster();
  WedgeRaster(WedgeRaster&&) noexcept;
  WedgeRaster& operator=(WedgeRaster&&) noexcept;

  /// Sets the content of the shader's last binding, which is a single 0 by default.
  void set_table(std::span<const double> table);

  /// Adds the faces' sums at the tile's receivers, row by row; sets `push.width` and the tile's rows.
  void add(std::span<const gpu::WedgeFace> faces, std::span<const gpu::WedgeReceiver> receivers, gpu::WedgePush push,
           const visibility::Tile& tile, std::uint32_t width);

  /// Returns for each receiver of the last add() its sums, usually in units of gpu::kSumUnit, and whether the host must
  /// handle it.
  [[nodiscard]] std::span<const std::int64_t> sums() const;
  [[nodiscard]] std::span<const std::uint32_t> doubts() const;

  [[nodiscard]] std::uint32_t max_tile_rows(const visibility::ViewSamples& samples) const;
  std::vector<visibility::PassTime> take_pass_times();
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
