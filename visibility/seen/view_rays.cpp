// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen/view_rays.hpp"

#include "mesh/predicates.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra::visibility {

TriangleBits::TriangleBits(std::uint64_t triangles) : words_((triangles + 63) / 64) {}

std::uint64_t TriangleBits::count() const {
  std::uint64_t count = 0;
  for (const auto& word : words_)
    count += static_cast<std::uint64_t>(std::popcount(word.load(std::memory_order_relaxed)));
  return count;
}

bool TriangleBits::any(std::uint64_t first, std::uint64_t end) const {
  if (first == end) return false;
  for (std::uint64_t word = first / 64; word <= (end - 1) / 64; ++word) {
    std::uint64_t bits = words_[word].load(std::memory_order_relaxed);
    if (word == first / 64) bits &= ~std::uint64_t{0} << first % 64;
    if (word == (end - 1) / 64) bits &= ~std::uint64_t{0} >> (63 - (end - 1) % 64);
    if (bits != 0) return true;
  }
  return false;
}

namespace {

/// Margin in pixels: a pixel that cover() assigns to a triangle by rounding is outside the triangle by less than
/// this. For a triangle that is not seen edge-on the distance is 2⁻⁴⁹ R² / s, where R is the triangle's distance and
/// s its shortest edge. Pixel boxes as in visibility/tree/view_walk.cpp would be a metre wide at the far end of a
/// forest, and hold every leaf of a tree.
constexpr double kPixels = 0x1p-4;

constexpr double kEndless = std::numeric_limits<double>::infinity();

}  // namespace

/// Traversal of one pixel's ray, nearest nodes first.
class ViewRays::Walk {
 public:
  Walk(const ViewRays& rays, const ViewRay& ray) : rays_(rays), ray_(ray) {
    const PinholeCamera& camera = rays.camera_;
    pixel_ = kPixels * 2 * (camera.half_height ? 0 : camera.tan_half_fov) / camera.picture_height();
    everywhere_ = kPixels * 2 * camera.half_height.value_or(0) / camera.picture_height();
  }

  void run(std::vector<std::uint64_t>& bits, std::vector<SeenPoint>& points) {
    const PlacedMeshes& meshes = rays_.meshes_;
    const Line line(ray_.start, ray_.direction, glm::dvec3(everywhere_), pixel_);
    walk(
        meshes.tree(), [&](const MiddleBox& box) { return line.enter(box); },
        [&](std::uint32_t part) { walk_part(meshes.parts()[part], line); });
    for (const Met& met : met_) {
      if (met.t > nearest_) continue;
      bits.push_back(met.bit);
      const glm::vec3 p = glm::vec3(ray_.start + met.t * ray_.direction) + 0.0f;
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      const glm::dvec3 a = met.corners[0], b = met.corners[1], c = met.corners[2];
      glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
      if (glm::dot(n, ray_.direction) > 0) n = -n;
      points.push_back({p, glm::vec3(n)});
    }
  }

 private:
  /// A ray in a space in which boxes are axis-aligned: the world, or a part's own.
  struct Line {
    glm::dvec3 start, inverse;
    glm::dvec3 room;   ///< by which boxes are enlarged
    double pixel = 0;  ///< by which boxes are enlarged as well, times their distance

    Line(const glm::dvec3& from, const glm::dvec3& direction, const glm::dvec3& around, double pixels)
        : start(from), room(around), pixel(pixels) {
      // For a ray parallel to planes: a finite slope that moves all boxes beside the ray very far away.
      constexpr double kSteep = 1e200;
      for (int axis = 0; axis < 3; ++axis) {
        inverse[axis] = 1 / direction[axis];
        if (!(std::abs(inverse[axis]) < kSteep)) inverse[axis] = std::copysign(kSteep, inverse[axis]);
      }
    }

    /// Returns the parameter at which the ray enters the box, enlarged by the rounding of cover(); infinite if the ray
    /// misses.
    [[nodiscard]] double enter(const MiddleBox& box) const {
      const glm::dvec3 to = box.middle - start;
      const glm::dvec3 half = box.half + room + pixel * (sum_of_sides(to) + box.half.x + box.half.y + box.half.z);
      const glm::dvec3 one = (to - half) * inverse, other = (to + half) * inverse;
      const glm::dvec3 into = glm::min(one, other), out = glm::max(one, other);
      const double first = std::max({0.0, into.x, into.y, into.z}), last = std::min({out.x, out.y, out.z});
      return first <= last * (1 + 0x1p-40) ? first * (1 - 0x1p-40) : kEndless;
    }
  };

  struct Waiting {
    double enter;
    std::uint32_t node;
  };

  /// `enter`: parameter at which the ray enters a node's box.
  template <typename Enter, typename Take>
  void walk(const BoxTree& tree, const Enter& enter, const Take& take) {
    if (tree.empty()) return;
    std::array<Waiting, BoxTree::kDepth> stack;
    std::uint32_t top = 0;
    const auto wait = [&](std::uint32_t node, double at) {
      if (at <= nearest_ && at < kEndless) stack[top++] = {at, node};
    };
    wait(0, enter(tree.root().box));
    while (top > 0) {
      const Waiting waiting = stack[--top];
      if (waiting.enter > nearest_) continue;
      const BoxTree::Node& node = tree.node(waiting.node);
      if (node.count > 0) {
        for (const std::uint32_t item : tree.items(node)) take(item);
        continue;
      }
      const std::uint32_t first = waiting.node + 1, second = node.first;
      const double at_first = enter(tree.node(first).box), at_second = enter(tree.node(second).box);
      if (at_first < at_second)
        wait(second, at_second), wait(first, at_first);
      else
        wait(first, at_first), wait(second, at_second);
    }
  }

  void walk_part(const PlacedMeshes::Part& part, const Line& line) {
    const auto take = [&](std::uint32_t triangle) { this->take(part, triangle); };
    if (!part.has_own) {
      walk(
          *part.tree, [&](const MiddleBox& own) { return line.enter(part.box(own)); }, take);
      return;
    }
    // In the part's own space, boxes need no transform. A distance d in the world is at most own_reach · d along each
    // axis there; distances to all of the part's boxes are at most `far`, and the rounding of the transform is less
    // than 2⁻³⁰ of them.
    const glm::dvec3 from = ray_.start - part.offset;
    const double far = sum_of_sides(part.in_world.middle - ray_.start) + 2 * sum_of_sides(part.in_world.half);
    const double room = everywhere_ + pixel_ * far + part.room + 0x1p-30 * (sum_of_sides(from) + far);
    const Line own(part.to_own * from, part.to_own * ray_.direction, part.own_reach * room, 0);
    walk(
        *part.tree, [&](const MiddleBox& box) { return own.enter(box); }, take);
  }

  void take(const PlacedMeshes::Part& part, std::uint32_t triangle) {
    const std::array<glm::vec3, 3> corners = rays_.meshes_.corners(part, triangle);
    const std::optional<double> t = cover(ray_, corners);
    if (!t || *t > nearest_ || mesh::collinear(corners[0], corners[1], corners[2])) return;
    met_.push_back({*t, part.first_bit + triangle, corners});
    if (rays_.is_solid_[rays_.meshes_.object(part, triangle)] != 0) nearest_ = *t;
  }

  const ViewRays& rays_;
  const ViewRay& ray_;
  double pixel_ = 0, everywhere_ = 0;
  double nearest_ = kEndless;  // distance of the nearest opaque triangle
  std::vector<Met> met_;
};

ViewRays::ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera) : meshes_(meshes), camera_(camera) {
  for (const scenes::Object& object : meshes.scene().objects)
    is_solid_.push_back(object.alpha.mode == scenes::Alpha::Mode::opaque ? 1 : 0);
}

void ViewRays::look(std::uint32_t x, std::uint32_t y, std::vector<std::uint64_t>& bits,
                    std::vector<SeenPoint>& points) const {
  const ViewRay ray = camera_.ray(x, y);
  Walk(*this, ray).run(bits, points);
}

}  // namespace penumbra::visibility
