// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "visibility/bounds.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// An eight-wide bounding volume hierarchy over the triangles that cast shadows, by the surface area heuristic in
/// blocks of eight. Designed for vector code with one lane for each child or triangle. A function of the scene alone,
/// independent of the number of threads.
struct TriangleTree {
  static constexpr std::uint32_t kWidth = 8;
  static constexpr std::uint32_t kNoChild = 0xffffffffu;
  static constexpr std::uint32_t kLeafBit = 0x80000000u;
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;

  struct Child {
    glm::vec3 lower{0}, upper{0};
    std::uint32_t reference = kNoChild;  ///< a node, or kLeafBit | leaf, or kNoChild
  };
  using Node = std::array<Child, kWidth>;
  using Leaf = std::array<std::uint32_t, kWidth>;  ///< triangles; kNoTriangle in unused slots at the end

  UnsetList<Node> nodes;    ///< the root is node 0; empty if nothing casts shadows
  UnsetList<Leaf> leaves;   ///< depth first: leaves below a node are contiguous
  std::uint32_t depth = 0;  ///< nodes on the longest path from root to leaf

  /// Calls `visit(triangle)` for each triangle in a leaf whose box touches [lower, upper].
  template <typename Visit>
  void for_each_near(const glm::vec3& lower, const glm::vec3& upper, Visit&& visit) const;

  /// Calls `visit(triangle)` for each triangle in a leaf whose box satisfies `volume.touches(lower, upper)`.
  template <typename Volume, typename Visit>
  void for_each_in(const Volume& volume, Visit&& visit) const;

  /// Returns whether `visit(triangle)` is true for one of the triangles in leaves whose boxes the segment p→l touches;
  /// stops at the first. Boxes are enlarged (by 2⁻⁴⁰ of the segment), which exceeds double rounding.
  template <typename Visit>
  bool any_along(const glm::dvec3& p, const glm::dvec3& l, Visit&& visit) const;
  /// Returns whether `visit(triangle)` is true for one of the triangles near the ray p + t · direction, t ≥ 0, as
  /// any_along does.
  template <typename Visit>
  bool any_along_ray(const glm::dvec3& p, const glm::dvec3& direction, Visit&& visit) const;

 private:
  template <typename Direction, typename Visit>
  bool any_touched(const Direction& direction, Visit&& visit) const;
};

TriangleTree make_triangle_tree(const SceneFloats& scene);

/// Makes a tree of the same form over any boxes (of edges, for example): leaves contain their indices.
TriangleTree make_tree_over(std::span<const Bounds> boxes);

template <typename Visit>
void TriangleTree::for_each_near(const glm::vec3& lower, const glm::vec3& upper, Visit&& visit) const {
  std::vector<std::uint32_t> stack;
  if (!nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Node& node = nodes[stack.back()];
    stack.pop_back();
    for (const Child& child : node) {
      if (child.reference == kNoChild) continue;
      bool touches = true;
      for (int axis = 0; axis < 3; ++axis)
        touches = touches && child.lower[axis] <= upper[axis] && child.upper[axis] >= lower[axis];
      if (!touches) continue;
      if ((child.reference & kLeafBit) == 0) {
        stack.push_back(child.reference);
        continue;
      }
      for (const std::uint32_t triangle : leaves[child.reference & ~kLeafBit]) {
        if (triangle != kNoTriangle) visit(triangle);
      }
    }
  }
}

/// A line p + t · direction and a box: calls narrow(first, last) with the range of t between each pair of opposite
/// planes; returns false if the line is parallel to a pair and outside of it.
class LineAndBox {
 public:
  LineAndBox(const glm::dvec3& p, const glm::dvec3& direction) : p_(p), inverse_(1.0 / direction) {}

 protected:
  template <typename Narrow>
  [[nodiscard]] bool between_planes(const glm::vec3& lower, const glm::vec3& upper, Narrow&& narrow) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double from = lower[axis] - p_[axis], to = upper[axis] - p_[axis];
      if (std::isinf(inverse_[axis])) {
        if (from > 0 || to < 0) return false;
        continue;
      }
      const double t0 = from * inverse_[axis], t1 = to * inverse_[axis];
      narrow(std::min(t0, t1), std::max(t0, t1));
    }
    return true;
  }

 private:
  glm::dvec3 p_, inverse_;
};

/// Computes the range of a segment from p along `direction` (p→l), within 0 … 1, that is in a box.
class SegmentInBox : private LineAndBox {
 public:
  using LineAndBox::LineAndBox;

  [[nodiscard]] bool touches(const glm::vec3& lower, const glm::vec3& upper) const {
    double enter = -0x1p-40, leave = 1 + 0x1p-40;
    return between_planes(lower, upper,
                          [&](double first, double last) {
                            enter = std::max(enter, first - 0x1p-40);
                            leave = std::min(leave, last + 0x1p-40);
                          }) &&
           enter <= leave;
  }
};

/// Tests whether the ray p + t · direction, t ≥ 0, touches a box. p is a float, so its start is not rounded; ends of
/// ranges are widened by more than their double rounding.
class RayInBox : private LineAndBox {
 public:
  using LineAndBox::LineAndBox;

  [[nodiscard]] bool touches(const glm::vec3& lower, const glm::vec3& upper) const {
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    return between_planes(lower, upper,
                          [&](double first, double last) {
                            enter = std::max(enter, first - 0x1p-40 * std::abs(first));
                            leave = std::min(leave, last + 0x1p-40 * std::abs(last));
                          }) &&
           enter <= leave;
  }
};

template <typename Volume, typename Visit>
void TriangleTree::for_each_in(const Volume& volume, Visit&& visit) const {
  static_cast<void>(any_touched(volume, [&](std::uint32_t triangle) {
    visit(triangle);
    return false;
  }));
}

template <typename Visit>
bool TriangleTree::any_along(const glm::dvec3& p, const glm::dvec3& l, Visit&& visit) const {
  return any_touched(SegmentInBox(p, l - p), visit);
}

template <typename Visit>
bool TriangleTree::any_along_ray(const glm::dvec3& p, const glm::dvec3& direction, Visit&& visit) const {
  return any_touched(RayInBox(p, direction), visit);
}

template <typename Direction, typename Visit>
bool TriangleTree::any_touched(const Direction& segment, Visit&& visit) const {
  std::vector<std::uint32_t> stack;
  if (!nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Node& node = nodes[stack.back()];
    stack.pop_back();
    for (const Child& child : node) {
      if (child.reference == kNoChild || !segment.touches(child.lower, child.upper)) continue;
      if ((child.reference & kLeafBit) == 0) {
        stack.push_back(child.reference);
        continue;
      }
      for (const std::uint32_t triangle : leaves[child.reference & ~kLeafBit]) {
        if (triangle != kNoTriangle && visit(triangle)) return true;
      }
    }
  }
  return false;
}

}  // namespace penumbra::visibility
