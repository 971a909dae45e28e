// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/depth_pyramid.shared.h"
#include "render/compute_pass.hpp"

#include <cstdint>
#include <memory>

namespace penumbra::maps {

/// Position of a pyramid's nodes; see depth_pyramid.shared.h.
enum class PyramidKind : std::uint8_t { hsm, mssm, ysm };

/// Returns the header of a pyramid over `faces` maps of size² texels. An MSSM or a YSM that would not fit into
/// `most_bytes` has quadtree levels up to the first level from which on the rest fits: if upper levels were left out
/// instead, a query of a whole map would need as many nodes as the coarsest level has. Throws ResourceError, with the
/// largest possible size, if not even a quadtree fits.
gpu::PyramidHeader pyramid_header(PyramidKind kind, std::uint32_t size, std::uint32_t faces, std::uint64_t most_bytes);

/// Returns the bytes of the pyramid's nodes.
std::uint64_t pyramid_bytes(const gpu::PyramidHeader& header, std::uint32_t faces);

/// Smallest and largest stored depths over squares of the maps of one light point: a PyramidHeader, followed by pairs
/// of floats. Queried in depth_pyramid.glsl.
class DepthPyramid final : public MapProduct {
 public:
  DepthPyramid(const render::Device& device, PyramidKind kind);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *nodes_; }

 private:
  const render::Device* device_;
  PyramidKind kind_;
  render::ComputePass pass_;
  std::unique_ptr<render::Buffer> nodes_;
};

/// Structure that bounds the depths in a view sample's kernel.
enum class Search : std::uint8_t { none, hsm, mssm, ysm };

/// Returns the option `search` of methods that need the depths of a kernel.
constexpr visibility::ChoiceOption<Search, 4> search_option(Search otherwise) {
  return {"search",
          {{"none", Search::none}, {"hsm", Search::hsm}, {"mssm", Search::mssm}, {"ysm", Search::ysm}},
          otherwise,
          "depths that bound a view sample's search: only the nearest depth of the map, or the depths in the sample's "
          "kernel, from a min-max pyramid (hsm), a multi-scale one (mssm), or both (ysm)"};
}

/// Returns the kind of `search`, which must not be none.
PyramidKind pyramid_of(Search search);

}  // namespace penumbra::maps
