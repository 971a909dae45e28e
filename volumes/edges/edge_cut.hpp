#pragma once

#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/light_window.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Edges at a light's plane: what is behind it shades nothing, and its projection could be anywhere.
namespace penumbra::volumes {

/// A half-space on one side of a light's plane. The rectangle tells which triangles reach through the light.
struct LightSide {
  std::array<glm::dvec3, 3> plane{};  ///< three points of it, as stored: (1 − 0) × (2 − 0) points to where sign is +1
  glm::dvec3 center{0}, u{0}, v{0};
  double sign = 1;          ///< +1: where u × v points; −1: behind
  float scale = 1;          ///< visibility::device_scale: positions are taken as devices store them
  LightWindow window = {};  ///< where CutEnds keeps places

  /// As devices store it: rounded where its scaled value is subnormal.
  [[nodiscard]] glm::vec3 stored(const glm::vec3& x) const { return x * scale / scale; }
  /// 1 in front of the plane, 0 in it, −1 behind. Exact.
  [[nodiscard]] int place_of(const glm::vec3& x) const;
};

/// Does anything lie behind that plane, so that records must be cut?
bool reaches_behind(const visibility::SceneFloats& scene, const LightSide& side);

class CutEnds;

/// Cuts the record at the plane; false: nothing of it is in front. What is cut is rounded to float. With `ends` the
/// record stays whole, and has the number of its ends there (EdgeRecord::cut).
bool keep_in_front(EdgeRecord& record, const LightSide& side, CutEnds* ends = nullptr);

/// Third edges, in the plane, of those triangles that it cuts and that may pass through the light itself
/// (docs/signed-crossings.md, cut edges): beside the light, no light sample is between those and any p. `ends`, if
/// given, takes their ends before rounding.
std::vector<EdgeRecord> edges_in_plane(const visibility::SceneFloats& scene, const EdgeCasters& casters,
                                       std::span<const std::uint32_t> triangles, const LightSide& side,
                                       CutEnds* ends = nullptr);

/// All records in front of the plane, cut, and the third edges.
std::vector<EdgeRecord> cut_records(const visibility::SceneFloats& scene, const EdgeCasters& casters,
                                    const LightSide& side);

}  // namespace penumbra::volumes
