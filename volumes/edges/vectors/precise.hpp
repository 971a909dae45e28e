#pragma once

#include "volumes/edges/vectors/group.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
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
  const ClusterInput& of;
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

/// An edge as it appears on the light, from the end nearer to the light's middle, so that far ends' errors, which grow
/// with their distance, stay small.
struct ProjectedEdge {
  glm::vec2 near{0}, far{0}, low{0}, high{0};
  float error_near = 0, error_far = 0, slope = 0, steep = 0;
  bool turn = false;        ///< near is b
  bool may_be_cut = false;  ///< at the light's plane: its stored ends are rounded

  [[nodiscard]] const glm::vec2& a() const { return turn ? far : near; }
  [[nodiscard]] const glm::vec2& b() const { return turn ? near : far; }
};
/// Nothing: no part of it is near the light, or it passes through p within rounding, which opens the pixel.
std::optional<ProjectedEdge> place_edge(const PreciseInput& input, Open& open);
/// On which side of the edge's plane through p a light point is, exactly, given the way to it (of any length): > 0 left
/// of the edge a→b as it appears; 0: within double rounding.
int side_of_way(const PreciseInput& input, const glm::dvec3& way);

/// Adds what the edge changes, and marks what is open because of it. For light samples in rows.
template <typename Counter>
void scatter_precisely(const PreciseInput& input, const Changes<Counter>& changes, Open& open);

}  // namespace penumbra::volumes
