// SPDX-License-Identifier: Apache-2.0
// No segment from p to the light meets a triangle if a plane separates the triangle from the hull of p and the light.
// The planes of faces are tried, as for any two convex bodies (Gottschalk, Lin, Manocha 1996): those through p
// and two neighbouring corners of the light, the light's own, the carrier's (objects below it are on no segment to a
// light point above it), those through p and an edge of the triangle, and the triangle's own. Each test allows for
// rounding in favour of meeting:
//
// - A computed point of the light is within kRoom · size of the hull of the corners used here, size the largest
//   coordinate of p and light (for a sun's directions: 1 + tangent). Stored corners are rounded to float32 once, frames
//   are differences of stored corners: at most four roundings of 2⁻²⁴ · size in a coordinate, a distance of √3 · 2⁻²² ·
//   size.
// - Products of differences of floats, in double, have rounding errors below kRounding of the product of their lengths:
//   a difference, 2⁻⁵³ of itself; a cross product of two and its dot product with a third, less than 16 · 2⁻⁵³.

#include "visibility/alpha/alpha_reach.hpp"

#include "base/size1.hpp"
#include "base/assert.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace penumbra::visibility {
namespace {

constexpr double kRoom = 0x1p-20, kRounding = 0x1p-46;

bool sees_it(PixelClass pixel) {
  return pixel == PixelClass::judged || pixel == PixelClass::horizon || pixel == PixelClass::other_body;
}

/// A half-space that contains all segments: normal · (x − p) ≤ most + slope · |x − p|.
struct Wall {
  glm::dvec3 normal{0};
  double most = 0, slope = 0;
};

/// All segments (or rays) from one p to a light.
class Directions {
 public:
  explicit Directions(const Light& light) : light_(light), ends_(!light.sun) {
    if (light.dome) {  // all directions: only objects behind the carrier are not met
    } else if (light.sun) {
      const glm::dvec3 u = light.sun->tangent * glm::dvec3(light.sun->axis_u),
                       v = light.sun->tangent * glm::dvec3(light.sun->axis_v), middle(light.center);
      corners_ = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
      room_ = kRoom * (1 + light.sun->tangent);
    } else if (is_body(light.kind)) {
      corners_.resize(4);
    } else {
      corners_.assign(light.outline.begin(), light.outline.end());
      normal_ = glm::cross(glm::dvec3(light.center_u) - glm::dvec3(light.center),
                           glm::dvec3(light.center_v) - glm::dvec3(light.center));
    }
  }

  void start_at(const SceneFloats& scene, const ViewSamples& samples, std::size_t pixel) {
    p_ = samples.p[pixel];
    if (is_body(light_.kind)) {
      const auto [c, u, v] = light_frame_from(light_, samples.p[pixel]);
      corners_ = {c - u - v, c + u - v, c + u + v, c - u + v};
      normal_ = glm::cross(u, v);
    }
    directions_.clear();
    for (const glm::dvec3& corner : corners_) directions_.push_back(ends_ ? corner - p_ : corner);
    if (ends_) {
      double size = size1(p_);
      for (const glm::dvec3& corner : corners_) size = std::max(size, size1(corner));
      room_ = kRoom * size;
    }
    walls_.clear();
    glm::dvec3 middle(0);
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const glm::dvec3 normal = glm::cross(directions_[i], directions_[i + 1 < directions_.size() ? i + 1 : 0]);
      add_wall(glm::dot(normal, directions_[(i + 2) % directions_.size()]) > 0 ? -normal : normal);
      middle += directions_[i];
    }
    add_wall(-middle);
    if (ends_) {
      add_wall(normal_);
      add_wall(-normal_);
    }
    // Points of segments have heights over the carrier's plane between that of p, which is taken as exactly 0, and that
    // of a light point above the plane.
    const auto [a, b, c] = scene.corners(static_cast<std::uint32_t>(samples.triangle[pixel]));
    const glm::dvec3 first = glm::dvec3(b) - glm::dvec3(a), second = glm::dvec3(c) - glm::dvec3(a);
    const glm::dvec3 down = -static_cast<double>(samples.facing[pixel]) * glm::cross(first, second),
                     to_plane = glm::dvec3(a) - p_;
    const double rounding = kRounding * size1(first) * size1(second);
    walls_.push_back({down, std::max(glm::dot(down, to_plane), 0.0) + rounding * size1(to_plane), rounding});
  }

  /// Returns whether the box may be met.
  [[nodiscard]] bool touch(const glm::vec3& lower, const glm::vec3& upper) const {
    const glm::dvec3 from = glm::dvec3(lower) - p_, to = glm::dvec3(upper) - p_;
    const double reach = size1(glm::max(glm::abs(from), glm::abs(to)));
    return std::ranges::none_of(walls_, [&](const Wall& wall) {
      const glm::dvec3 least = glm::min(wall.normal * from, wall.normal * to);
      return least.x + least.y + least.z > wall.most + wall.slope * reach;
    });
  }

  /// Returns whether the triangle may be met.
  [[nodiscard]] bool touch(const std::array<glm::vec3, 3>& corners) const {
    const std::array to{glm::dvec3(corners[0]) - p_, glm::dvec3(corners[1]) - p_, glm::dvec3(corners[2]) - p_};
    const double reach = std::max({size1(to[0]), size1(to[1]), size1(to[2])});
    for (const auto& [normal, most, slope] : walls_) {
      const double least = std::min({glm::dot(normal, to[0]), glm::dot(normal, to[1]), glm::dot(normal, to[2])});
      if (least > most + slope * reach) return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_beside_edge(to[i], to[(i + 1) % 3], to[(i + 2) % 3])) return false;
    }
    return !is_beside_plane(to);
  }

 private:
  /// Adds a wall orthogonal to `normal`: through p, or as far along the normal as the segments reach.
  void add_wall(const glm::dvec3& normal) {
    double most = 0;
    for (const glm::dvec3& direction : directions_) most = std::max(most, glm::dot(normal, direction));
    const double size = size1(normal), reach = most + size * room_;
    // A sun's direction d has a length of at least 1 − 2⁻²⁰, so a point x = p + t d has t ≤ |x − p| (1 + 2⁻¹⁹).
    walls_.push_back(ends_ ? Wall{normal, reach, kRounding * size}
                           : Wall{normal, 0, reach * (1 + 0x1p-18) + kRounding * size});
  }

  /// Returns whether the plane through p and the edge a b has the third corner on one side and the light on the other.
  [[nodiscard]] bool is_beside_edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& third) const {
    if (directions_.empty()) return false;
    glm::dvec3 normal = glm::cross(a, b);
    const double size = size1(a) * size1(b), side = glm::dot(normal, third);
    if (!(std::abs(side) > kRounding * size * size1(third))) return false;
    if (side < 0) normal = -normal;
    return std::ranges::all_of(directions_, [&](const glm::dvec3& direction) {
      return glm::dot(normal, direction) < -size * (room_ + kRounding * size1(direction));
    });
  }

  /// Returns whether p and the light are on one side of the triangle's plane.
  [[nodiscard]] bool is_beside_plane(const std::array<glm::dvec3, 3>& to) const {
    if (directions_.empty()) return false;
    const glm::dvec3 first = to[1] - to[0], second = to[2] - to[0];
    glm::dvec3 normal = glm::cross(first, second);
    const double size = size1(first) * size1(second), height = -glm::dot(normal, to[0]);
    const double error = kRounding * size * size1(to[0]);
    if (!(std::abs(height) > error)) return false;
    if (height < 0) normal = -normal;
    const double least = ends_ ? -(std::abs(height) - error) : 0;  // for a segment's end, its height minus p's; for a
                                                                   // ray, the direction's
    return std::ranges::all_of(directions_, [&](const glm::dvec3& direction) {
      return glm::dot(normal, direction) > least + size * (room_ + kRounding * size1(direction));
    });
  }

  const Light& light_;
  bool ends_;                        // segments, not rays
  std::vector<glm::dvec3> corners_;  // for a sun, directions; for a dome none
  glm::dvec3 normal_{0};             // normal of the light's plane
  double room_ = 0;
  glm::dvec3 p_{0};
  std::vector<glm::dvec3> directions_;
  std::vector<Wall> walls_;
};

/// A box around all segments from a block of pixels. Culls blocks far from all surfaces that let light through.
class BlockSegments {
 public:
  explicit BlockSegments(const Light& light) {
    if (light.dome) {
      lower_ = glm::vec3(-kEndless);
      upper_ = glm::vec3(kEndless);
      return;
    }
    if (!light.sun) {
      const Bounds points = point_bounds(light);
      add(points.lower);
      add(points.upper);
      for (const glm::vec3& corner : light.outline) add(corner);
      const float room = 4 * static_cast<float>(kRoom) * (float_size1(lower_) + float_size1(upper_));
      lower_ -= room;
      upper_ += room;
      return;
    }
    const glm::vec3 aside = static_cast<float>(light.sun->tangent * (1 + kRoom)) *
                            (glm::abs(light.sun->axis_u) + glm::abs(light.sun->axis_v));
    const float room = 4 * static_cast<float>(kRoom * (1 + light.sun->tangent));
    for (int axis = 0; axis < 3; ++axis) {  // a ray that may go down does so without end
      if (light.center[axis] - aside[axis] < room) lower_[axis] = -kEndless;
      if (light.center[axis] + aside[axis] > -room) upper_[axis] = kEndless;
    }
  }
  void add(const glm::vec3& x) {
    lower_ = glm::min(lower_, x);
    upper_ = glm::max(upper_, x);
  }
  [[nodiscard]] bool touch(const glm::vec3& lower, const glm::vec3& upper) const {
    return glm::all(glm::lessThanEqual(lower, upper_)) && glm::all(glm::greaterThanEqual(upper, lower_));
  }

 private:
  static constexpr float kEndless = std::numeric_limits<float>::infinity();
  static float float_size1(const glm::vec3& x) { return std::abs(x.x) + std::abs(x.y) + std::abs(x.z); }
  glm::vec3 lower_{kEndless}, upper_{-kEndless};
};

/// Returns whether `meets(triangle)` is true for a triangle in a box that `volume` touches.
template <typename Volume, typename Meets>
bool any_in(const TriangleTree& tree, const Volume& volume, Meets&& meets) {
  bool found = false;
  struct UntilFound {
    const Volume& volume;
    const bool& found;
    bool touches(const glm::vec3& lower, const glm::vec3& upper) const { return !found && volume.touch(lower, upper); }
  };
  tree.for_each_in(UntilFound{volume, found}, [&](std::uint32_t i) { found = found || meets(i); });
  return found;
}

}  // namespace

TriangleTree make_tree_over_alphas(const SceneFloats& scene) {
  std::vector<Bounds> boxes;
  for (const std::uint32_t triangle : scene.alphas.casters) {
    const auto [a, b, c] = scene.corners(triangle);
    boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
  }
  return make_tree_over(boxes);
}

AlphaReach::AlphaReach(const SceneFloats& scene) : scene_(scene), tree_(make_tree_over_alphas(scene)) {}

std::vector<std::uint8_t> AlphaReach::reached(const ViewSamples& samples, const Light& light,
                                              std::span<const PixelClass> classes) const {
  PENUMBRA_ASSERT(classes.size() == samples.size(), "{} classes of {} pixels", classes.size(), samples.size());
  if (tree_.nodes.empty()) return {};
  constexpr std::uint32_t kBlock = 16;
  const std::uint32_t width = samples.width, height = samples.height;
  std::vector<std::uint8_t> reached(samples.size());
  std::atomic<bool> any = false;
  const BlockSegments to_light(light);
  tbb::parallel_for(
      tbb::blocked_range2d<std::uint32_t>(0, (height + kBlock - 1) / kBlock, 0, (width + kBlock - 1) / kBlock),
      [&](const auto& blocks) {
        Directions directions(light);
        const auto do_block = [&](std::uint32_t top, std::uint32_t left) {
          const std::uint32_t bottom = std::min(top + kBlock, height), right = std::min(left + kBlock, width);
          const auto for_each_pixel = [&](auto&& visit) {
            for (std::uint32_t y = top; y < bottom; ++y) {
              for (std::size_t i = std::size_t{y} * width + left; i < std::size_t{y} * width + right; ++i) {
                if (sees_it(classes[i])) visit(i);
              }
            }
          };
          BlockSegments all = to_light;
          for_each_pixel([&](std::size_t i) { all.add(samples.p[i]); });
          if (!any_in(tree_, all, [](std::uint32_t) { return true; })) return;
          for_each_pixel([&](std::size_t i) {
            const auto carrier = static_cast<std::uint32_t>(samples.triangle[i]);
            directions.start_at(scene_, samples, i);
            if (!any_in(tree_, directions, [&](std::uint32_t caster) {
                  const std::uint32_t triangle = scene_.alphas.casters[caster];
                  return may_filter(scene_, light, carrier, triangle) && directions.touch(scene_.corners(triangle));
                }))
              return;
            reached[i] = 1;
            any = true;
          });
        };
        for (std::uint32_t y = blocks.rows().begin(); y != blocks.rows().end(); ++y) {
          for (std::uint32_t x = blocks.cols().begin(); x != blocks.cols().end(); ++x) do_block(y * kBlock, x * kBlock);
        }
      });
  if (!any) reached.clear();
  return reached;
}

}  // namespace penumbra::visibility
