// SPDX-License-Identifier: Apache-2.0
// Builds pyramids of depth ranges: Guennebaud, Barthe and Paulin 2006 (HSM), Schwarz and Stamminger 2007 (MSSM) and
// 2008 (YSM), Yang et al. 2009 (the dual grid). Departures: all three are on the dual grid and differ in one number,
// the spacing of the nodes of a level; the dual grid has one more cell on either side, between the map's border and the
// empty outside; the map's width need not be a power of two.

#include "maps/products/depth_pyramid.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/products/depth_pyramid.comp.spv.hpp"

#include <span>

namespace penumbra::maps {
namespace {

/// Last quadtree level of a YSM: levels 0, 1 and 2 form a quadtree, below an MSSM of a sixteenth of the nodes. The
/// papers give no number.
constexpr std::uint32_t kWholeOfHybrid = 2;
constexpr std::uint32_t kPyramidGroup = 64;

std::uint64_t nodes_of(const gpu::PyramidHeader& header, std::uint32_t level, std::uint32_t faces) {
  const std::uint64_t side = gpu::pyramid_nodes(header.cells, gpu::pyramid_shift(level, header.whole));
  return side * side * faces;
}

/// Returns the level up to which the nodes of a pyramid of this kind are spaced by their width.
std::uint32_t whole_of(PyramidKind kind, std::uint32_t size) {
  switch (kind) {
    case PyramidKind::hsm:
      return gpu::pyramid_log2(size) + 1;  // 2^whole ≥ size + 1: one node covers all cells
    case PyramidKind::ysm:
      return kWholeOfHybrid;
    case PyramidKind::mssm:
      break;
  }
  return 0;
}

gpu::PyramidHeader header_of(std::uint32_t whole, std::uint32_t size) {
  gpu::PyramidHeader header{};
  header.cells = size + 1;
  header.whole = whole;
  header.top = whole + gpu::pyramid_log2(gpu::pyramid_nodes(header.cells, whole));
  return header;
}

}  // namespace

std::uint64_t pyramid_bytes(const gpu::PyramidHeader& header, std::uint32_t faces) {
  std::uint64_t nodes = 0;
  for (std::uint32_t level = 0; level <= header.top; ++level) nodes += nodes_of(header, level, faces);
  return nodes * sizeof(glm::vec2);
}

gpu::PyramidHeader pyramid_header(PyramidKind kind, std::uint32_t size, std::uint32_t faces, std::uint64_t most_bytes) {
  const std::uint32_t quadtree = whole_of(PyramidKind::hsm, size);
  const auto fits = [&](const gpu::PyramidHeader& header) {
    return sizeof header + pyramid_bytes(header, faces) <= most_bytes;
  };
  gpu::PyramidHeader header = header_of(whole_of(kind, size), size);
  while (header.whole < quadtree && !fits(header)) header = header_of(header.whole + 1, size);
  PENUMBRA_ASSERT(header.top < gpu::kPyramidLevels, "{} levels", header.top + 1);
  if (!fits(header)) {
    std::uint32_t less = size;
    while (less > 1 && !fits(header_of(whole_of(PyramidKind::hsm, less), less))) --less;
    throw ResourceError(
        "method option size={}: a pyramid over {} maps needs {} bytes, more than one buffer here can hold; take "
        "size={} "
        "or less",
        size, faces, pyramid_bytes(header, faces), less);
  }
  std::uint64_t first = 0;
  for (std::uint32_t level = 0; level <= header.top; ++level) {
    header.first[level] = static_cast<std::uint32_t>(first);
    first += nodes_of(header, level, faces);
  }
  return header;
}

DepthPyramid::DepthPyramid(const render::Device& device, PyramidKind kind)
    : device_(&device),
      kind_(kind),
      pass_(device, {.name = "depth pyramid",
                     .spirv = shaders::kDepthPyramidComp,
                     .push_bytes = sizeof(gpu::PyramidPush),
                     .constants = {}}) {}

void DepthPyramid::record(render::Commands& commands, const MapSet& maps) {
  const gpu::PyramidHeader header =
      pyramid_header(kind_, maps.size, maps.faces, device_->limits().max_storage_buffer_range);
  render::grow(*device_, nodes_, "depth pyramid", sizeof header + pyramid_bytes(header, maps.faces));
  nodes_->write<gpu::PyramidHeader>(std::span(&header, 1));
  for (std::uint32_t level = 0; level <= header.top; ++level) {
    const std::uint32_t below = level == 0 ? 0 : level - 1;
    const gpu::PyramidPush push{.cells = header.cells,
                                .faces = maps.faces,
                                .level = level,
                                .shift = gpu::pyramid_shift(level, header.whole),
                                .shift_below = gpu::pyramid_shift(below, header.whole),
                                .first = header.first[level],
                                .first_below = header.first[below]};
    const std::uint64_t nodes = nodes_of(header, level, maps.faces);
    pass_.record(commands, push, {maps.depths, *nodes_}, (nodes + kPyramidGroup - 1) / kPyramidGroup);
  }
}

PyramidKind pyramid_of(Search search) {
  PENUMBRA_ASSERT(search != Search::none, "no pyramid for search=none");
  if (search == Search::hsm) return PyramidKind::hsm;
  return search == Search::mssm ? PyramidKind::mssm : PyramidKind::ysm;
}

}  // namespace penumbra::maps
