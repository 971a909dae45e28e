// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/light_window.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Edges at a light's plane: objects behind the plane cast no shadow, and their projection could be anywhere.
namespace penumbra::volumes {

/// A half-space on one side of a light's plane. The rectangle determines which triangles reach through the light.
struct LightSide {
  std::array<glm::dvec3, 3> plane{};  ///< three stored points of the plane: (1 − 0) × (2 − 0) points to the side with
                                      ///< sign +1
  glm::dvec3 center{0}, u{0}, v{0};
  double sign = 1;          ///< +1: the side that u × v points to; −1: the other side
  float scale = 1;          ///< visibility::device_scale: positions are rounded as on devices
  LightWindow window = {};  ///< coordinates of CutEnds' places

  /// Returns x as devices store it: rounded where its scaled value is subnormal.
  [[nodiscard]] glm::vec3 stored(const glm::vec3& x) const { return x * scale / scale; }
  /// Returns 1 in front of the plane, 0 in it, −1 behind. Exact.
  [[nodiscard]] int place_of(const glm::vec3& x) const;
};

/// Returns whether anything lies behind the plane, so that records must be cut.
bool reaches_behind(const visibility::SceneFloats& scene, const LightSide& side);

class CutEnds;

/// Cuts the record at the plane; returns false if nothing of it is in front. Cut ends are rounded to float. If `ends`
/// is given, the record's points stay as they are, and the record gets the index of its cut ends (EdgeRecord::cut).
bool keep_in_front(EdgeRecord& record, const LightSide& side, CutEnds* ends = nullptr);

/// Returns the third edges: the edges in the plane of those triangles that the plane cuts and that may pass through the
/// light itself (docs/signed-crossings.md, cut edges). Outside of the light, no light sample is between a third edge
/// and any p. `ends`, if given, receives their ends before rounding.
std::vector<EdgeRecord> edges_in_plane(const visibility::SceneFloats& scene, const EdgeCasters& casters,
                                       std::span<const std::uint32_t> triangles, const LightSide& side,
                                       CutEnds* ends = nullptr);

/// Returns all records in front of the plane, cut, and the third edges.
std::vector<EdgeRecord> cut_records(const visibility::SceneFloats& scene, const EdgeCasters& casters,
                                    const LightSide& side);

}  // namespace penumbra::volumes
