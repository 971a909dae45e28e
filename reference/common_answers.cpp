// SPDX-License-Identifier: Apache-2.0
// Finds directions in which nothing, or one large triangle, is in the way of all rays from a box.
//
// A ray along d from a point of the box B meets the box N only if the ray from 0 along d meets N − B, the box of all
// differences. So each node of the tree is tested once, with the directions that are left at its parent.

#include "reference/common_answers.hpp"

#include "visibility/float_meeting.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::reference {
namespace {

using visibility::Bounds;
using visibility::SceneFloats;
using visibility::TriangleTree;

double largest_side(const glm::vec3& lower, const glm::vec3& upper) {
  const glm::dvec3 sides = glm::dvec3(upper) - glm::dvec3(lower);
  return std::max({sides.x, sides.y, sides.z});
}

}  // namespace

struct CommonAnswers::Search {
  const CommonAnswers& directions;
  const Bounds& box;
  const std::uint32_t own;
  const std::span<std::uint32_t> clear;
  const double side;                  // the box's largest side
  const double room;                  // margin of all boxes, since points are rounded
  std::vector<std::uint32_t> active;  // lists of directions: those of a node follow those of its parent

  void block(std::size_t first) {
    for (std::size_t i = first; i < active.size(); ++i) clear[active[i] / 32] &= ~(1U << (active[i] % 32));
  }

  /// Appends the directions from `first` to `last` that are still clear and may meet a box.
  void append_meeting(std::size_t first, std::size_t last, const glm::vec3& lower, const glm::vec3& upper) {
    glm::dvec3 from = glm::dvec3(lower) - glm::dvec3(box.upper), to = glm::dvec3(upper) - glm::dvec3(box.lower);
    const glm::dvec3 far = glm::max(glm::abs(from), glm::abs(to));
    const double around = room + visibility::kFloatBeside * (far.x + far.y + far.z);
    from -= around;
    to += around;
    std::size_t end = active.size();
    active.resize(end + (last - first));
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t j = active[i];
      const glm::dvec3 one = from * directions.inverse_[j], other = to * directions.inverse_[j];
      const glm::dvec3 into = glm::min(one, other), out = glm::max(one, other);
      const double enter = std::max(std::max(0.0, into.x), std::max(into.y, into.z)),
                   leave = std::min(out.x, std::min(out.y, out.z));
      active[end] = j;
      const bool meets = enter <= leave * (1 + 0x1p-40) && ((clear[j / 32] >> (j % 32)) & 1U) != 0;
      end += meets ? 1 : 0;
    }
    active.resize(end);
  }

  void walk(std::uint32_t number, std::size_t first, std::size_t last) {
    for (const TriangleTree::Child& child : directions.tree_.nodes[number]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const bool is_leaf = (child.reference & TriangleTree::kLeafBit) != 0;
      const std::uint32_t below = child.reference & ~TriangleTree::kLeafBit;
      if ((is_leaf ? directions.leaf_plane_ : directions.node_plane_)[below] == own) continue;
      const std::size_t start = active.size();
      append_meeting(first, last, child.lower, child.upper);
      if (active.size() > start) {
        if (largest_side(child.lower, child.upper) <= side)
          block(start);  // descending would not help: rays from a box this large would meet the smaller boxes, too
        else if (is_leaf)
          try_triangles(directions.tree_.leaves[below], start);
        else
          walk(below, start, active.size());
      }
      active.resize(start);
    }
  }

  void try_triangles(const TriangleTree::Leaf& leaf, std::size_t first) {
    const std::size_t last = active.size();
    for (const std::uint32_t triangle : leaf) {
      if (triangle == TriangleTree::kNoTriangle || directions.scene_->plane[triangle] == own) continue;
      const auto [a, b, c] = directions.scene_->corners(triangle);
      append_meeting(first, last, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
      block(last);
      active.resize(last);
    }
  }
};

CommonAnswers::CommonAnswers(const SceneFloats& scene, std::span<const glm::vec3> directions)
    : scene_(&scene), tree_(visibility::make_triangle_tree(scene)) {
  node_plane_.assign(tree_.nodes.size(), SceneFloats::kNoPlane);
  leaf_plane_.assign(tree_.leaves.size(), SceneFloats::kNoPlane);
  if (!tree_.nodes.empty()) note_plane(0);
  choose_large();
  set_directions(directions);
}

/// Returns the plane of all triangles below a node or leaf, and stores it; kNoPlane if there are several.
std::uint32_t CommonAnswers::note_plane(std::uint32_t reference) {
  const std::uint32_t number = reference & ~TriangleTree::kLeafBit;
  std::uint32_t common = SceneFloats::kNoPlane;
  bool is_first = true;
  const auto add = [&](std::uint32_t plane) {
    common = is_first || plane == common ? plane : SceneFloats::kNoPlane;
    is_first = false;
  };
  if (number != reference) {
    for (const std::uint32_t triangle : tree_.leaves[number]) {
      if (triangle != TriangleTree::kNoTriangle) add(scene_->plane[triangle]);
    }
    return leaf_plane_[number] = common;
  }
  for (const TriangleTree::Child& child : tree_.nodes[number]) {
    if (child.reference != TriangleTree::kNoChild) add(note_plane(child.reference));
  }
  return node_plane_[number] = common;
}

/// Chooses triangles that may hide a direction from many pixels at once, as walls and floors do: the largest, down to a
/// sixteenth of the largest area.
void CommonAnswers::choose_large() {
  constexpr std::size_t kMost = 16;
  std::vector<std::pair<double, std::uint32_t>> areas;
  for (std::uint32_t i = 0; i < scene_->triangles.size(); ++i) {
    if (scene_->casts_shadow[i] == 0) continue;
    const auto [a, b, c] = scene_->corners(i);
    areas.emplace_back(-glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a))), i);
  }
  const std::size_t count = std::min(kMost, areas.size());
  std::partial_sort(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(count), areas.end());
  for (const auto& [area, triangle] : std::span(areas).first(count)) {
    if (area * 16 <= areas.front().first) large_.push_back(scene_->corners(triangle));
  }
}

void CommonAnswers::set_directions(std::span<const glm::vec3> directions) {
  constexpr double kSteep = 1e200;  // in place of infinity, whose product with 0 is no number
  directions_.assign(directions.begin(), directions.end());
  inverse_.clear();
  for (const glm::dvec3& direction : directions_) inverse_.push_back(glm::clamp(1.0 / direction, -kSteep, kSteep));
}

void CommonAnswers::keep_clear(const Bounds& box, std::uint32_t own, std::span<std::uint32_t> clear) const {
  if (tree_.nodes.empty() || node_plane_[0] == own) return;
  const glm::vec3 far = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  std::vector<std::uint32_t> active;
  for (std::uint32_t j = 0; j < inverse_.size(); ++j) {
    if (((clear[j / 32] >> (j % 32)) & 1U) != 0) active.push_back(j);
  }
  const std::size_t count = active.size();
  Search{*this,
         box,
         own,
         clear,
         largest_side(box.lower, box.upper),
         visibility::kFloatBeside * std::max({far.x, far.y, far.z}),
         std::move(active)}
      .walk(0, 0, count);
}

void CommonAnswers::add_blocked(const Bounds& box, std::span<std::uint32_t> blocked) const {
  const visibility::RayStarts starts(box.lower, box.upper);
  for (const std::array<glm::vec3, 3>& corners : large_) {
    for (std::size_t j = 0; j < directions_.size(); ++j) {
      if (((blocked[j / 32] >> (j % 32)) & 1U) == 0 &&
          visibility::float_rays_meet(starts, directions_[j], corners) == visibility::FloatMeeting::surely)
        blocked[j / 32] |= 1U << (j % 32);
    }
  }
}

}  // namespace penumbra::reference
