#pragma once

#include "volumes/native_scatter.hpp"

/// One edge for one view sample, number by number: edges that come near p's height, and whatever may be within rounding
/// of a light sample. The same operations as the vectors', so that a vertex is in one place. Inside volumes/ only.
namespace penumbra::volumes {

/// Changes of the depth: [column · padded_rows + row], and where edges cross the light's left side, a row each.
template <typename Counter>
struct Changes {
  Counter* cells;
  Counter* left;
};

struct PreciseInput {
  const Frame& frame;
  const Sample& at;
  const EdgeTable& edges;
  std::size_t edge;
  float k;       ///< as seen from the light's front
  bool open;     ///< p is within rounding of one of its triangles' planes
  bool settled;  ///< well above p
};
/// Marks what is open because of the edge; with `changes`, adds what it changes.
template <typename Counter>
void scatter_precisely(const PreciseInput& input, const Changes<Counter>* changes, Open& open);

}  // namespace penumbra::volumes
