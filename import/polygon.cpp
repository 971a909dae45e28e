// SPDX-License-Identifier: Apache-2.0
// Triangulates polygons by fans or ear clipping.

#include "import/polygon.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

// Triangulation of polygons by fans or ear clipping. How to cut a polygon that is neither flat nor simple is a
// convention, not a fact of its geometry, so plain double arithmetic decides here; no later step depends on these
// signs, and the number of triangles never does.

namespace penumbra::import {
namespace {

/// Returns Newell's normal: the sum of the edges' cross products; its length is twice the area of a flat polygon.
glm::dvec3 mean_normal(std::span<const glm::dvec3> corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  }
  return sum;
}

/// Returns the corners projected along the axis closest to the mean normal, oriented counter-clockwise.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> corners) {
  const glm::dvec3 normal = mean_normal(corners);
  const glm::dvec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const glm::length_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 p = corner - corners[0];
    flat.emplace_back(normal[axis] >= 0 ? glm::dvec2(p[u], p[v]) : glm::dvec2(p[v], p[u]));
  }
  return flat;
}

/// Returns twice the signed area of the triangle a b c: positive if it runs counter-clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Sine of an angle that counts as zero: a corner in the middle of a straight side is off its line by the rounding of
/// single precision in files. A triangle cut off there would have no area, or be a sliver, although a better one can be
/// cut elsewhere.
constexpr double kStraight = 0x1p-20;

/// Returns turn(a, b, c) for a turn at b whose sine is `sine`, or up to twice that: lengths are estimated by sums of
/// coordinates.
double turn_of_sine(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, double sine) {
  const glm::dvec2 u = glm::abs(b - a), v = glm::abs(c - b);
  return sine * (u.x + u.y) * (v.x + v.y);
}

bool turns_left(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, double sine) {
  return turn(a, b, c) > turn_of_sine(a, b, c, sine);
}

bool turns_right(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return turn(a, b, c) < -turn_of_sine(a, b, c, kStraight);
}

enum class Shape { round, straight_corners, other };

/// Classifies an outline. round: convex, and every triangle of the fan around corner 0 has three corners that are not
/// straight, or the polygon has no area at all. straight_corners: convex, but that fan would have triangles without
/// area.
Shape shape_of(std::span<const glm::dvec2> outline) {
  const std::size_t count = outline.size();
  bool has_area = false;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % count], &c = outline[(i + 2) % count];
    if (turns_right(a, b, c)) return Shape::other;
    has_area |= turns_left(a, b, c, kStraight);
  }
  // A pentagram also turns left everywhere, but its fan turns right somewhere.
  bool clear = true;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const glm::dvec2 &a = outline[0], &b = outline[i], &c = outline[i + 1];
    if (turns_right(a, b, c)) return Shape::other;
    clear &= turns_left(a, b, c, kStraight) && turns_left(b, c, a, kStraight) && turns_left(c, a, b, kStraight);
  }
  return clear || !has_area ? Shape::round : Shape::straight_corners;
}

/// Cuts a convex polygon from its leftmost to its rightmost corner, as monotone polygons are cut (Garey, Johnson,
/// Preparata and Tarjan 1978): in linear time, without cutting off straight corners, independent of the first corner.
class Zipper {
 public:
  Zipper(std::span<const glm::dvec2> outline, std::vector<mesh::Triangle>& triangles)
      : outline_(outline), triangles_(triangles) {}

  void run() {
    const auto before = [&](std::uint32_t i, std::uint32_t j) {
      return std::tie(outline_[i].x, outline_[i].y) < std::tie(outline_[j].x, outline_[j].y);
    };
    const auto count = static_cast<std::uint32_t>(outline_.size());
    std::uint32_t first = 0, last = 0;
    for (std::uint32_t i = 1; i < count; ++i) {
      if (before(i, first)) first = i;
      if (before(last, i)) last = i;
    }
    stack_ = {first};
    // `below` follows the order of the corners, `above` runs against it; the leftmost of the two comes next.
    std::uint32_t below = (first + 1) % count, above = (first + count - 1) % count;
    while (below != last || above != last) {
      const bool is_below = above == last || (below != last && before(below, above));
      add(is_below ? below : above, is_below);
      (is_below ? below : above) = is_below ? (below + 1) % count : (above + count - 1) % count;
    }
    close(last);
  }

 private:
  void add(std::uint32_t corner, bool below) {
    if (stack_.size() > 1 && below != below_) {
      const std::uint32_t top = stack_.back();
      close(corner);
      stack_ = {top};
    }
    below_ = below;
    while (stack_.size() > 1 && can_cut(stack_[stack_.size() - 2], stack_.back(), corner)) {
      cut(stack_[stack_.size() - 2], stack_.back(), corner);
      stack_.pop_back();
    }
    stack_.push_back(corner);
  }

  /// Cuts the triangles from `corner` to all corners on the stack.
  void close(std::uint32_t corner) {
    for (std::size_t i = 0; i + 1 < stack_.size(); ++i) cut(stack_[i], stack_[i + 1], corner);
  }

  [[nodiscard]] bool can_cut(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    if (!below_) std::swap(a, c);
    return turns_left(outline_[a], outline_[b], outline_[c], kStraight);
  }
  void cut(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles_.push_back(below_ ? mesh::Triangle{a, b, c} : mesh::Triangle{c, b, a});
  }

  std::span<const glm::dvec2> outline_;
  std::vector<mesh::Triangle>& triangles_;
  std::vector<std::uint32_t> stack_;  ///< corners that still miss triangles; all but the first are on one side
  bool below_ = true;                 ///< the side of these corners
};

/// The corners that are not cut off yet, in the cells of a grid, so that an ear is tested against near corners only.
class CornerGrid {
 public:
  explicit CornerGrid(std::span<const glm::dvec2> outline) : outline_(outline) {
    glm::dvec2 high = outline[0];
    low_ = outline[0];
    for (const glm::dvec2& p : outline) low_ = glm::min(low_, p), high = glm::max(high, p);
    constexpr std::size_t kWorthAGrid = 256;
    if (outline.size() > kWorthAGrid) side_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(outline.size())));
    cell_ = (high - low_) / static_cast<double>(side_);
    cells_.resize(side_ * side_);
    for (std::uint32_t i = 0; i < outline.size(); ++i) cells_[cell_of(outline[i])].push_back(i);
  }

  void remove(std::uint32_t corner) { std::erase(cells_[cell_of(outline_[corner])], corner); }

  /// Returns whether blocks(place) is true for any corner within the box, or near it.
  template <typename Blocks>
  [[nodiscard]] bool any(const glm::dvec2& low, const glm::dvec2& high, const Blocks& blocks) const {
    for (std::size_t y = index(low, 1); y <= index(high, 1); ++y) {
      for (std::size_t x = index(low, 0); x <= index(high, 0); ++x) {
        for (const std::uint32_t corner : cells_[y * side_ + x]) {
          if (blocks(outline_[corner])) return true;
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] std::size_t index(const glm::dvec2& p, glm::length_t axis) const {
    const double at = (p[axis] - low_[axis]) / cell_[axis];  // NaN if the outline has no extent
    return at > 0 ? std::min(static_cast<std::size_t>(std::min(at, 1e9)), side_ - 1) : 0;
  }
  [[nodiscard]] std::size_t cell_of(const glm::dvec2& p) const { return index(p, 1) * side_ + index(p, 0); }

  std::span<const glm::dvec2> outline_;
  glm::dvec2 low_{0}, cell_{0};
  std::size_t side_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

bool is_ear(std::span<const glm::dvec2> outline, const CornerGrid& corners, std::span<const std::uint32_t> ring,
            std::size_t tip, double sine) {
  const std::size_t count = ring.size();
  const glm::dvec2 a = outline[ring[(tip + count - 1) % count]], b = outline[ring[tip]],
                   c = outline[ring[(tip + 1) % count]];
  if (!turns_left(a, b, c, sine)) return false;
  const glm::dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c)),
                   more = 4 * sine * (high - low);
  return !corners.any(low - more, high + more, [&](const glm::dvec2& p) {
    if (p == a || p == b || p == c) return false;  // also true at a bridge to a hole, which visits corners twice
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= -turn_of_sine(c, a, p, sine);
  });
}

}  // namespace

PolygonKind triangulate_polygon(std::span<const glm::dvec3> corners, std::vector<mesh::Triangle>& triangles) {
  PENUMBRA_ASSERT(corners.size() >= 3, "a polygon with {} corners", corners.size());
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0u);
  const auto fan = [&] {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({ring[0], ring[i], ring[i + 1]});
  };
  if (corners.size() == 3) return fan(), PolygonKind::convex;
  const glm::dvec3 normal = mean_normal(corners);
  // later checks refuse such positions
  if (!std::isfinite(normal.x + normal.y + normal.z)) return fan(), PolygonKind::convex;
  const std::vector<glm::dvec2> outline = project(corners);
  const Shape shape = shape_of(outline);
  if (shape == Shape::round) return fan(), PolygonKind::convex;
  if (shape == Shape::straight_corners) return Zipper(outline, triangles).run(), PolygonKind::convex;

  CornerGrid grid(outline);
  double sine = kStraight;
  std::size_t tip = 0, tries = 0;
  while (ring.size() > 3 && (tries < ring.size() || sine > 0)) {
    const std::size_t count = ring.size();
    if (tries == count) {  // only slivers are left
      sine = 0;
      tries = 0;
    }
    if (!is_ear(outline, grid, ring, tip, sine)) {
      tip = (tip + 1) % count;
      ++tries;
      continue;
    }
    triangles.push_back({ring[(tip + count - 1) % count], ring[tip], ring[(tip + 1) % count]});
    grid.remove(ring[tip]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(tip));
    tip %= ring.size();  // continues with the next corner, not around the same one: gives fewer slivers
    tries = 0;
    sine = kStraight;
  }
  const bool stuck = ring.size() > 3;
  fan();
  return stuck ? PolygonKind::tangled : PolygonKind::concave;
}

}  // namespace penumbra::import
