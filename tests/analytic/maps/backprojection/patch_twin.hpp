// SPDX-License-Identifier: Apache-2.0
#pragma once
// Backprojection of every texel of a light's maps, one by one, in double and without kernels: what backproject must
// compute where all casters are well in front of all receivers, so that rounding does not decide which texels hide
// light.

#include "tests/analytic/maps/centre_maps.hpp"

namespace penumbra::tests {

enum class Fill { none, edges, diagonal, shared };
enum class Occluder { patch, quad, triangle };

class PatchTwin {
 public:
  /// With `level`, blocks of 2^level texels a side act as one texel at their nearest depth.
  PatchTwin(const render::Device& device, const Stage& stage, std::uint32_t size, std::uint32_t level = 0)
      : stage_(&stage),
        maps_(device, stage, size, {0, 0}, {.whole_light = true}),
        block_(1U << level),
        size_((size + block_ - 1) / block_) {
    const std::vector<float> fine = maps_.read();
    texels_.assign(std::size_t{maps_.fitted.faces} * size_ * size_, 1);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const std::size_t x = i % size / block_, y = i / size % size / block_, face = i / size / size;
      if (face >= maps_.fitted.faces) break;
      float& coarse = texels_[(face * size_ + y) * size_ + x];
      coarse = std::min(coarse, fine[i]);
    }
  }

  [[nodiscard]] std::uint32_t faces() const { return maps_.fitted.faces; }
  using Polygon = std::vector<glm::dvec2>;

  /// Whether the receiver is farther from the light's plane than anything in the maps; otherwise a texel may reach
  /// beyond the receiver's height.
  [[nodiscard]] bool is_below_all_casters(std::size_t pixel) const {
    const double height = std::abs(maps_.basis.local(stage_->samples.p[pixel]).z);
    double deepest = 0;
    for (std::size_t i = 0; i < stage_->floats.triangles.size(); ++i) {
      if (stage_->floats.casts_shadow[i] == 0) continue;
      for (const glm::vec3& corner : stage_->floats.corners(static_cast<std::uint32_t>(i))) {
        deepest = std::max(deepest, std::abs(maps_.basis.local(corner).z));
      }
    }
    return height > 1.05 * deepest;
  }

  /// Returns the areas that bitmask's occluders cover in the light's plane, as convex polygons; patches only for maps
  /// of one window.
  [[nodiscard]] std::vector<Polygon> occluders(std::size_t pixel, Occluder kind) const {
    const glm::dvec3 d = maps_.basis.local(stage_->samples.p[pixel]);
    const maps::gpu::SideView& side = maps_.fitted.views.front().side[d.z < 0 ? 1 : 0];
    const glm::dvec3 e(d.x, d.y, std::abs(d.z));
    std::vector<Polygon> found;
    for (std::uint32_t number = 0; number < side.face_count; ++number) {
      const Face face = face_of(side, number);
      for (std::uint32_t y = 0; y < size_; ++y) {
        for (std::uint32_t x = 0; x < size_; ++x) {
          if (kind == Occluder::patch) {
            const double depth = hiding(side, number, e, x, y);
            if (depth == 0) continue;
            const glm::dvec2 from = face.lower + glm::dvec2(x, y) * face.texel, to = from + face.texel;
            found.push_back({on_light(face, e, from, depth), on_light(face, e, {to.x, from.y}, depth),
                             on_light(face, e, to, depth), on_light(face, e, {from.x, to.y}, depth)});
            continue;
          }
          if (x + 1 == size_ || y + 1 == size_) continue;
          Polygon centres;
          std::size_t missing = 0;
          const std::array<std::pair<std::uint32_t, std::uint32_t>, 4> at{
              {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
          std::array<glm::dvec2, 4> seen;
          for (std::size_t k = 0; k < 4; ++k) {
            const double depth = hiding(side, number, e, at[k].first, at[k].second);
            if (depth == 0) {
              missing = k;
              continue;
            }
            seen[k] = on_light(face, e, face.lower + (glm::dvec2(at[k].first, at[k].second) + 0.5) * face.texel, depth);
            centres.push_back(seen[k]);
          }
          if (centres.size() == 4) {
            found.push_back({seen[0], seen[1], seen[2]});
            found.push_back({seen[0], seen[2], seen[3]});
          } else if (centres.size() == 3 && kind == Occluder::triangle) {
            found.push_back({seen[(missing + 1) % 4], seen[(missing + 2) % 4], seen[(missing + 3) % 4]});
          }
        }
      }
    }
    return found;
  }

  /// Returns the smallest distance of a point from the sides of a convex polygon of either winding; negative if the
  /// point is outside.
  static double inside(const Polygon& polygon, const glm::dvec2& at) {
    double least = 1e30, most = -1e30;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double length = glm::length(b - a);
      if (length == 0) continue;
      const double side = ((b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x)) / length;
      least = std::min(least, side);
      most = std::max(most, side);
    }
    return std::max(least, -most);
  }
  [[nodiscard]] glm::dvec2 light_sample(std::uint32_t j) const {
    return glm::dvec2(maps_.basis.local(stage_->light.points[j]));
  }

  /// Returns 1 − the sum of all patches' shares of a rectangle light.
  [[nodiscard]] double visibility(std::size_t pixel, Fill fill) const {
    const glm::dvec3 d = maps_.basis.local(stage_->samples.p[pixel]);
    const maps::gpu::LightView& view = maps_.fitted.views.front();
    const maps::gpu::SideView& side = view.side[d.z < 0 ? 1 : 0];
    const glm::dvec3 e(d.x, d.y, std::abs(d.z));
    double sum = 0;
    for (std::uint32_t face = 0; face < side.face_count; ++face) {
      for (std::uint32_t y = 0; y < size_; ++y) {
        for (std::uint32_t x = 0; x < size_; ++x) sum += hidden(side, face, e, x, y, fill);
      }
    }
    return 1 - std::min(sum, 1.0);
  }

 private:
  struct Face {
    glm::dvec2 lower, texel;
    std::array<glm::dvec3, 3> axes;  // a, b, w
  };
  [[nodiscard]] Face face_of(const maps::gpu::SideView& side, std::uint32_t number) const {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const std::array<std::array<glm::dvec3, 3>, 5> axes{{{x, y, z}, {y, z, x}, {y, z, -x}, {x, z, y}, {x, z, -y}}};
    glm::dvec2 lower = side.lower, upper = side.upper;
    if (side.face_count > 1) {
      lower = {-1, number == 0 ? -1 : 0};
      upper = {1, 1};
    }
    return {lower, static_cast<double>(block_) * (upper - lower) / static_cast<double>(maps_.size), axes[number]};
  }

  /// Returns the depth along the face's axis if the texel hides light from e, otherwise 0.
  [[nodiscard]] double hiding(const maps::gpu::SideView& side, std::uint32_t number, const glm::dvec3& e,
                              std::int64_t x, std::int64_t y) const {
    const auto size = static_cast<std::int64_t>(size_);
    if (x < 0 || y < 0) return 0;
    const auto at = static_cast<std::size_t>(((side.first_face + number) * size + y) * size + x);
    const double depth = texels_[at];
    if (depth == 1) return 0;
    const Face face = face_of(side, number);
    const glm::dvec2 centre = face.lower + (glm::dvec2(x, y) + 0.5) * face.texel;
    const glm::dvec3 direction = centre.x * face.axes[0] + centre.y * face.axes[1] + face.axes[2];
    const double found = depth * static_cast<double>(maps_.fitted.views.front().far);
    return found * direction.z < e.z ? found : 0;
  }

  /// Returns where the line from e through a face's point at this depth meets the light's plane.
  static glm::dvec2 on_light(const Face& face, const glm::dvec3& e, const glm::dvec2& at, double depth) {
    const glm::dvec3 q = depth * (at.x * face.axes[0] + at.y * face.axes[1] + face.axes[2]);
    const glm::dvec3 s = e + (q - e) * (e.z / (e.z - q.z));
    return glm::dvec2(s);
  }

  [[nodiscard]] double hidden(const maps::gpu::SideView& side, std::uint32_t number, const glm::dvec3& e,
                              std::uint32_t x, std::uint32_t y, Fill fill) const {
    const double depth = hiding(side, number, e, x, y);
    if (depth == 0) return 0;
    const Face face = face_of(side, number);
    const glm::dvec2 from = face.lower + glm::dvec2(x, y) * face.texel, to = from + face.texel;
    Polygon polygon{on_light(face, e, from, depth), on_light(face, e, {to.x, from.y}, depth),
                    on_light(face, e, to, depth), on_light(face, e, {from.x, to.y}, depth)};
    if (fill != Fill::none) {
      // Only for maps of one window: an axis-parallel rectangle.
      glm::dvec2 lower = polygon[0];
      const auto reach = [&](int dx, int dy) {
        const double neighbour = hiding(side, number, e, std::int64_t{x} + dx, std::int64_t{y} + dy);
        if (neighbour == 0) return;
        const glm::dvec2 seen = on_light(face, e, from, neighbour);
        const bool anywhere = fill == Fill::shared;
        if (dx != 0 && (anywhere || seen.x < lower.x)) lower.x = std::min(seen.x, polygon[2].x);
        if (dy != 0 && (anywhere || seen.y < lower.y)) lower.y = std::min(seen.y, polygon[2].y);
      };
      reach(-1, 0);
      reach(0, -1);
      if (fill == Fill::diagonal) reach(-1, -1);
      polygon = {lower, {polygon[2].x, lower.y}, polygon[2], {lower.x, polygon[2].y}};
    }
    return area_in_light(polygon) / stage_->light.area;
  }

  [[nodiscard]] double area_in_light(Polygon polygon) const {
    const maps::LightBounds bounds = maps::light_bounds(stage_->light, maps_.basis);
    for (int axis = 0; axis < 2; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const double limit = sign < 0 ? -bounds.lower[axis] : bounds.upper[axis];
        Polygon inside;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
          const double over_a = limit - sign * a[axis], over_b = limit - sign * b[axis];
          if (over_a >= 0) inside.push_back(a);
          if ((over_a >= 0) != (over_b >= 0)) inside.push_back(glm::mix(a, b, over_a / (over_a - over_b)));
        }
        polygon = std::move(inside);
      }
    }
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
  }

  const Stage* stage_;
  CentreMaps maps_;
  std::uint32_t block_, size_;  ///< map texels per side of a block, and blocks per side of the map
  std::vector<float> texels_;
};

}  // namespace penumbra::tests
