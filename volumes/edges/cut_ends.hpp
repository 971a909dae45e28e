// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/edge_cut.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

/// Points where edges cross a light's plane, before rounding: for areas, which rounding to float would affect. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// An end of an edge. Usually a point (scaled). Where an edge crosses the plane on the light or near it: the place on
/// the light as a fraction of its window (LightSide::window), rounded once from the exact value, regardless of the
/// angle between edge and plane.
struct CutEnd {
  glm::dvec3 point{0};
  std::optional<glm::dvec2> place = {};
};

class CutEnds {
 public:
  struct Edge {
    CutEnd a, b;
  };
  /// The crossing of the edge a b with the plane. If a = b: that point, which is in the plane.
  struct Crossing {
    glm::vec3 a{0}, b{0};
  };

  explicit CutEnds(const LightSide& side);
  ~CutEnds();
  CutEnds(CutEnds&&) noexcept;
  CutEnds& operator=(CutEnds&&) noexcept;

  /// Stores an edge that crosses the plane or ends in it, cut there at its end a (`at_a`) or b. Returns its index.
  std::uint32_t of_edge(const glm::vec3& a, const glm::vec3& b, bool at_a);
  /// Stores an edge in the plane. Returns its index; 0 if the edge does not touch the light.
  std::uint32_t in_plane(const Crossing& from, const Crossing& to);

  /// Returns the unscaled point of an end in the plane.
  [[nodiscard]] glm::vec3 rounded(const CutEnd& end) const;
  [[nodiscard]] const Edge& operator[](std::uint32_t number) const { return edges_[number - 1]; }

 private:
  struct Plane;  // in rationals

  /// Returns an approximate crossing of the edge with the plane, if double proves that it is well outside of the light;
  /// else nullopt.
  [[nodiscard]] std::optional<glm::dvec3> far_crossing(const glm::dvec3& a, const glm::dvec3& b) const;
  /// Returns the place in the window, from (−1, −1) to (1, 1), of a point of the plane relative to the frame's centre.
  [[nodiscard]] glm::dvec2 in_window(const glm::dvec3& x) const;
  [[nodiscard]] glm::dvec3 stored(const glm::vec3& x) const { return side_.stored(x); }

  LightSide side_;
  std::unique_ptr<Plane> plane_;
  std::vector<Edge> edges_;
};

}  // namespace penumbra::volumes
