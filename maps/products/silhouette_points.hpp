#pragma once

#include "maps/host/map_method.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Where outlines pass between the texels of a map (Sen, Cammarano, Hanrahan 2003). A cell has the centres of four
/// texels as its corners; there is one more than texels on either side, and the outermost corners are none. Of an edge
/// that parts a cell's corners a point is kept, from 0 to 1 across the cell: its end, if that is inside, else where it
/// crosses the diagonals, or midway between where it crosses both. Of several edges the nearest to the light counts.
struct SilhouettePoint {
  glm::dvec2 at{0.5};
  double depth = 0;  ///< along the face's axis; 0: no outline
};
/// An end of an edge, in cells and its depth along the axis.
struct SilhouetteEnd {
  glm::dvec2 at{0};
  double depth = 0;
};
/// Adds the points of an edge to `count` × `count` cells, row by row. Which end is the first changes no bit.
void add_silhouette(const SilhouetteEnd& one, const SilhouetteEnd& other, std::uint32_t count,
                    std::vector<SilhouettePoint>& cells);

/// These of the silhouettes of all casters but the light's own body, as the light's centre sees them
/// (mesh::silhouette_edges: any soup), on the device: two floats a cell.
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
