// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/group.hpp"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <optional>

/// Scalar handling of one edge for one view sample: edges that come near p's height, and those within rounding of a
/// light sample. The operations are those of the vector code, so that a vertex is projected to one place. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// Changes of the depth: one for each light sample, at column · padded_rows + row; and, for each row, the changes where
/// edges cross the light's left side.
template <typename Counter>
struct Changes {
  Counter* cells;
  Counter* left;
};

struct PreciseInput {
  const ClusterInput& of;
  const ClusterSample& at;
  std::size_t edge;  ///< row in the EdgeTable
  float k;           ///< as seen from the light's front
  bool settled;      ///< whether the edge is well above p
  /// Projected ends, if the vector code has already added the edge's changes. Changes that it put on the wrong side of
  /// a light sample are then moved.
  std::optional<std::array<glm::vec2, 2>> projected;
};
/// Returns the exact k_e where p is within rounding of a triangle's plane. p may lie in the triangle itself, where two
/// surfaces cross; half of all directions from p then depend on k_e. Returns nullopt if p is in the plane.
std::optional<float> exact_multiplicity(const EdgeTable& edges, std::size_t edge, const ClusterSample& at,
                                        OpenJudge& judge);

/// A projected edge, described from the end nearer to the light's middle, so that the error of the far end, which grows
/// with its distance, has little effect.
struct ProjectedEdge {
  glm::vec2 near{0}, far{0}, low{0}, high{0};
  float error_near = 0, error_far = 0, slope = 0, steep = 0;
  bool turn = false;        ///< `near` is b
  bool may_be_cut = false;  ///< the edge may be cut at the light's plane: its stored ends are rounded

  [[nodiscard]] const glm::vec2& a() const { return turn ? far : near; }
  [[nodiscard]] const glm::vec2& b() const { return turn ? near : far; }
};
/// Projects the edge. Returns nullopt if no part of it is near the light, or if it passes through p within rounding,
/// which opens the pixel.
std::optional<ProjectedEdge> place_edge(const PreciseInput& input, Open& open);
/// Returns the exact side of the edge's plane through p that a light point is on, given the vector to it (of any
/// length): > 0 left of the projected edge a→b; 0: within double rounding.
int side_of_direction(const PreciseInput& input, const glm::dvec3& direction);

/// Adds the edge's changes, and marks the samples that it leaves open. Only for light samples in rows.
template <typename Counter>
void scatter_precisely(const PreciseInput& input, const Changes<Counter>& changes, Open& open);

}  // namespace penumbra::volumes
