// Guennebaud, Barthe and Paulin 2006 (HSM), Schwarz and Stamminger 2007 (MSSM) and 2008 (YSM), Yang et al. 2009 (the
// dual grid). Departures: all three stand on the dual grid and differ in one number, where the nodes of a level stand;
// the dual grid has a cell more on either side, between the map's border and the nothing beyond it; maps need not be a
// power of two wide.

#include "maps/products/depth_pyramid.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/products/depth_pyramid.comp.spv.hpp"

#include <span>

namespace penumbra::maps {
namespace {

/// The quadtree levels of a YSM: 0, 1 and 2, an MSSM of a sixteenth of the nodes above them. Papers name no number.
constexpr std::uint32_t kWholeOfHybrid = 2;
constexpr std::uint32_t kPyramidGroup = 64;

std::uint64_t nodes_of(const gpu::PyramidHeader& header, std::uint32_t level, std::uint32_t faces) {
  const std::uint64_t side = gpu::pyramid_nodes(header.cells, gpu::pyramid_shift(level, header.whole));
  return side * side * faces;
}

/// With all its levels.
gpu::PyramidHeader whole_header(PyramidKind kind, std::uint32_t size) {
  gpu::PyramidHeader header{};
  header.cells = size + 1;
  if (kind == PyramidKind::hsm) {
    header.top = header.whole = gpu::pyramid_log2(size) + 1;  // 2^top ≥ size + 1: one node covers all cells
  } else {
    header.whole = kind == PyramidKind::ysm ? kWholeOfHybrid : 0;
    header.top = header.whole + gpu::pyramid_log2(gpu::pyramid_nodes(header.cells, header.whole));
  }
  return header;
}

std::uint64_t least_bytes(PyramidKind kind, std::uint32_t size, std::uint32_t faces) {
  gpu::PyramidHeader header = whole_header(kind, size);
  header.top = header.whole;
  return pyramid_bytes(header, faces);
}

}  // namespace

std::uint64_t pyramid_bytes(const gpu::PyramidHeader& header, std::uint32_t faces) {
  std::uint64_t nodes = 0;
  for (std::uint32_t level = 0; level <= header.top; ++level) nodes += nodes_of(header, level, faces);
  return nodes * sizeof(glm::vec2);
}

gpu::PyramidHeader pyramid_header(PyramidKind kind, std::uint32_t size, std::uint32_t faces, std::uint64_t most_bytes) {
  gpu::PyramidHeader header = whole_header(kind, size);
  PENUMBRA_ASSERT(header.top < gpu::kPyramidLevels, "{} levels", header.top + 1);
  while (header.top > header.whole && sizeof header + pyramid_bytes(header, faces) > most_bytes) --header.top;
  if (sizeof header + pyramid_bytes(header, faces) > most_bytes) {
    std::uint32_t fits = size;
    while (fits > 1 && sizeof header + least_bytes(kind, fits, faces) > most_bytes) --fits;
    throw ResourceError(
        "method option size={}: a pyramid over {} maps needs {} bytes, more than one buffer here can hold; take "
        "size={} "
        "or less",
        size, faces, pyramid_bytes(header, faces), fits);
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
