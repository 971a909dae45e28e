#pragma once

#include "volumes/scatter/vectors/scatter.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <optional>

/// One edge for one view sample, number by number: edges that come near p's height, and whatever may be within rounding
/// of a light sample. The operations are those of the vectors, so that a vertex is projected to one place. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// Changes of the depth: [column · padded_rows + row], and where edges cross the light's left side, a row each.
template <typename Counter>
struct Changes {
  Counter* cells;
  Counter* left;
};

struct PreciseInput {
  const ScatterInput& scatter;
  const ClusterSample& at;
  std::size_t edge;  ///< in the EdgeTable
  float k;           ///< as seen from the light's front
  bool settled;      ///< well above p
  /// Where the vectors projected its ends, if they have added its changes: those on the wrong side of a light sample
  /// are moved.
  std::optional<std::array<glm::vec2, 2>> projected;
};
/// k_e where p is within rounding of a triangle's plane: exact, since p may lie in the triangle itself, where two
/// surfaces cross, and then half of all ways from p depend on it. Nothing: p is in the plane.
std::optional<float> exact_multiplicity(const EdgeTable& edges, std::size_t edge, const ClusterSample& at,
                                        OpenJudge& judge);

/// Adds what the edge changes, and marks what is open because of it.
template <typename Counter>
void scatter_precisely(const PreciseInput& input, const Changes<Counter>& changes, Open& open);

}  // namespace penumbra::volumes
