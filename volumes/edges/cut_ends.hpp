#pragma once

#include "volumes/edges/edge_cut.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

/// Where edges pass through a light's plane, before rounding: for areas that a float's rounding would show in. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// An end of an edge: a point (scaled); or, where an edge passes through the plane on the light or near it, the place
/// on the light, in shares of its window (LightSide::window): rounded once from the exact one, however little the
/// edge leaves the plane.
struct CutEnd {
  glm::dvec3 point{0};
  std::optional<glm::dvec2> place = {};
};

class CutEnds {
 public:
  struct Edge {
    CutEnd a, b;
  };
  /// Of the edge a b with the plane; a = b: a is on it.
  struct Crossing {
    glm::vec3 a{0}, b{0};
  };

  explicit CutEnds(const LightSide& side);
  ~CutEnds();
  CutEnds(CutEnds&&) noexcept;
  CutEnds& operator=(CutEnds&&) noexcept;

  /// The number of an edge that passes through the plane or ends in it, cut there at its end a, or b.
  std::uint32_t of_edge(const glm::vec3& a, const glm::vec3& b, bool at_a);
  /// The number of an edge in the plane; 0 if it does not touch the light.
  std::uint32_t in_plane(const Crossing& from, const Crossing& to);

  /// The point, not scaled, of an end in the plane.
  [[nodiscard]] glm::vec3 rounded(const CutEnd& end) const;
  [[nodiscard]] const Edge& operator[](std::uint32_t number) const { return edges_[number - 1]; }

 private:
  struct Plane;  // in rationals

  /// Near where the edge passes through the plane, if double knows that this is well beside the light.
  [[nodiscard]] std::optional<glm::dvec3> far_crossing(const glm::dvec3& a, const glm::dvec3& b) const;
  /// Of a point of the plane relative to the frame's centre, in the window from (−1, −1) to (1, 1).
  [[nodiscard]] glm::dvec2 in_window(const glm::dvec3& x) const;
  [[nodiscard]] glm::dvec3 stored(const glm::vec3& x) const { return side_.stored(x); }

  LightSide side_;
  std::unique_ptr<Plane> plane_;
  std::vector<Edge> edges_;
};

}  // namespace penumbra::volumes
