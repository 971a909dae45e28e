// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Silhouette point of a cell between the texels of a map (Sen, Cammarano, Hanrahan 2003). A cell has the centres of
/// four texels as its corners; there is one more cell than texels on either side, and the outermost corners do not
/// exist. For an edge that separates a cell's corners one point is kept, from 0 to 1 across the cell: the edge's end,
/// if inside, else its intersection with the diagonals, or the middle of both intersections. If there are several
/// edges, the nearest to the light counts.
struct SilhouettePoint {
  glm::dvec2 at{0.5};
  double depth = 0;  ///< along the face's axis; 0: no outline
};
/// End of an edge, in cells, and its depth along the axis.
struct SilhouetteEnd {
  glm::dvec2 at{0};
  double depth = 0;
};
/// Adds the points of an edge to `count` × `count` cells, row by row. Exchanging the ends changes no bit.
void add_silhouette(const SilhouetteEnd& one, const SilhouetteEnd& other, std::uint32_t count,
                    std::vector<SilhouettePoint>& cells);

/// Silhouette points of all casters but the light's own body, as seen from the light's centre (mesh::silhouette_edges,
/// for any triangles), on the device: two floats for each cell.
class SilhouettePoints final : public MapProduct {
 public:
  explicit SilhouettePoints(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *points_; }
  void add_counters(std::map<std::string, std::uint64_t>& counters) const override;

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> points_;
  std::uint64_t edges_ = 0, cells_ = 0;
};

}  // namespace penumbra::maps
