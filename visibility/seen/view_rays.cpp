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

/// Traversal of one pixel's ray, nearest nodes first.
class ViewRays::Walk {
 public:
  Walk(const ViewRays& rays, const ViewRay& ray, TriangleBits& seen, std::vector<SeenPoint>& points)
      : rays_(rays), ray_(ray), seen_(seen), points_(points) {
    // For a ray parallel to planes: a finite slope that moves all boxes beside the ray very far away.
    for (int axis = 0; axis < 3; ++axis) {
      inverse_[axis] = 1 / ray.direction[axis];
      if (!(std::abs(inverse_[axis]) < kSteep)) inverse_[axis] = std::copysign(kSteep, inverse_[axis]);
    }
    const PinholeCamera& camera = rays.camera_;
    pixel_ = kPixels * 2 * (camera.half_height ? 0 : camera.tan_half_fov) / camera.picture_height();
    everywhere_ = kPixels * 2 * camera.half_height.value_or(0) / camera.picture_height();
  }

  void run() {
    const PlacedMeshes& meshes = rays_.meshes_;
    walk(
        meshes.tree(), [](const MiddleBox& box) { return box; },
        [&](std::uint32_t part) { walk_part(meshes.parts()[part]); });
    for (const Met& met : met_) {
      if (met.t > nearest_) continue;
      seen_.set(met.bit);
      const glm::vec3 p = glm::vec3(ray_.start + met.t * ray_.direction) + 0.0f;
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      const glm::dvec3 a = met.corners[0], b = met.corners[1], c = met.corners[2];
      glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
      if (glm::dot(n, ray_.direction) > 0) n = -n;
      points_.push_back({p, glm::vec3(n)});
    }
  }

 private:
  static constexpr double kSteep = 1e200;
  /// Margin in pixels: a pixel that cover() assigns to a triangle by rounding is outside the triangle by less than
  /// this. For a triangle that is not seen edge-on the distance is 2⁻⁴⁹ R² / s, where R is the triangle's distance and
  /// s its shortest edge. Pixel boxes as in visibility/tree/view_walk.cpp would be a metre wide at the far end of a
  /// forest, and hold every leaf of a tree.
  static constexpr double kPixels = 0x1p-4;

  struct Waiting {
    double enter;
    std::uint32_t node;
  };

  /// Returns the parameter at which the ray enters the box, enlarged by the rounding of cover(); infinite if the ray
  /// misses.
  [[nodiscard]] double enter(const MiddleBox& box) const {
    const glm::dvec3 to = box.middle - ray_.start;
    const double room = everywhere_ + pixel_ * (sum_of_sides(to) + box.half.x + box.half.y + box.half.z);
    double first = 0, last = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double half = box.half[axis] + room;
      const double one = (to[axis] - half) * inverse_[axis], other = (to[axis] + half) * inverse_[axis];
      first = std::max(first, std::min(one, other));
      last = std::min(last, std::max(one, other));
    }
    return first <= last * (1 + 0x1p-40) ? first * (1 - 0x1p-40) : std::numeric_limits<double>::infinity();
  }

  template <typename BoxOf, typename Take>
  void walk(const BoxTree& tree, const BoxOf& box_of, const Take& take) {
    if (tree.empty()) return;
    std::array<Waiting, 64> stack;
    std::uint32_t top = 0;
    const auto wait = [&](std::uint32_t node) {
      const double at = enter(box_of(tree.node(node).box));
      if (at <= nearest_ && at < std::numeric_limits<double>::infinity()) stack[top++] = {at, node};
    };
    wait(0);
    while (top > 0) {
      const Waiting waiting = stack[--top];
      if (waiting.enter > nearest_) continue;
      const BoxTree::Node& node = tree.node(waiting.node);
      if (node.count > 0) {
        for (const std::uint32_t item : tree.items(node)) take(item);
        continue;
      }
      wait(waiting.node + 1);
      const std::uint32_t before = top;
      wait(node.first);
      if (before > 0 && top > before && stack[before - 1].node == waiting.node + 1 &&
          stack[before - 1].enter < stack[before].enter)
        std::swap(stack[before - 1], stack[before]);
    }
  }

  void walk_part(const PlacedMeshes::Part& part) {
    walk(
        *part.tree, [&](const MiddleBox& own) { return part.box(own); },
        [&](std::uint32_t triangle) {
          const std::array<glm::vec3, 3> corners = rays_.meshes_.corners(part, triangle);
          const std::optional<double> t = cover(ray_, corners);
          if (!t || *t > nearest_ || mesh::collinear(corners[0], corners[1], corners[2])) return;
          met_.push_back({*t, part.first_bit + triangle, corners});
          if (rays_.is_solid_[rays_.meshes_.object(part, triangle)] != 0) nearest_ = *t;
        });
  }

  const ViewRays& rays_;
  const ViewRay& ray_;
  TriangleBits& seen_;
  std::vector<SeenPoint>& points_;
  glm::dvec3 inverse_{0};
  double pixel_ = 0, everywhere_ = 0;
  double nearest_ = std::numeric_limits<double>::infinity();  // distance of the nearest opaque triangle
  std::vector<Met> met_;
};

ViewRays::ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera) : meshes_(meshes), camera_(camera) {
  for (const scenes::Object& object : meshes.scene().objects)
    is_solid_.push_back(object.alpha.mode == scenes::Alpha::Mode::opaque ? 1 : 0);
}

void ViewRays::look(std::uint32_t x, std::uint32_t y, TriangleBits& seen, std::vector<SeenPoint>& points) const {
  const ViewRay ray = camera_.ray(x, y);
  Walk(*this, ray, seen, points).run();
}

}  // namespace penumbra::visibility
