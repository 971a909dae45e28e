// SPDX-License-Identifier: Apache-2.0
#pragma once
// A closed form of the light that contours hide under the parallel square.

#include "maps/host/map_fit.hpp"
#include "tests/analytic/maps/parallel_square.hpp"

#include <numbers>
#include <utility>
#include <vector>

namespace penumbra::tests {

/// The area that contours hide under the parallel square: the texels whose centres the square covers, with corners cut
/// off midway to the next texels' centres, projected onto the light.
class OctagonTwin {
 public:
  /// With `level`, blocks of 2^level texels a side act as one texel, which shades if any texel of the block does.
  OctagonTwin(const Stage& stage, std::uint32_t size, std::uint32_t level = 0) : stage_(&stage) {
    const maps::LightBasis basis = maps::light_basis(stage.light);
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis);
    const glm::vec3 centre(basis.center);
    const auto fitted = maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1),
                                        {.size = size, .reach = glm::max(-bounds.lower, bounds.upper)});
    const maps::gpu::SideView& side = fitted.views.front().side[0];
    basis_ = basis;
    glm::dvec2 lower(1e30), upper(-1e30);
    for (std::size_t i = 6; i < 12; ++i) {  // the floor has the first six positions, the occluder the next six
      const glm::dvec3 corner = basis.local(stage.floats.positions[i]);
      lower = glm::min(lower, glm::dvec2(corner) / corner.z);
      upper = glm::max(upper, glm::dvec2(corner) / corner.z);
      height_ = corner.z;
    }
    texel_ = (glm::dvec2(side.upper) - glm::dvec2(side.lower)) / static_cast<double>(size);
    // The contour: first and last texels (or blocks) whose centres the square covers, and half a texel beyond them.
    const double block = 1U << level;
    glm::dvec2 first = glm::ceil((lower - glm::dvec2(side.lower)) / texel_ - 0.5);
    glm::dvec2 last = glm::floor((upper - glm::dvec2(side.lower)) / texel_ - 0.5);
    first = glm::floor(first / block) - 0.5;
    last = glm::floor(last / block) + 0.5;
    texel_ *= block;
    const glm::dvec2 a = glm::dvec2(side.lower) + (first + 0.5) * texel_,
                     b = glm::dvec2(side.lower) + (last + 0.5) * texel_;
    const glm::dvec2 half = 0.5 * texel_;
    outline_ = {{a.x + half.x, a.y}, {b.x - half.x, a.y}, {b.x, a.y + half.y}, {b.x, b.y - half.y},
                {b.x - half.x, b.y}, {a.x + half.x, b.y}, {a.x, b.y - half.y}, {a.x, a.y + half.y}};
    if (stage.light.kind == visibility::LightKind::disk) {
      constexpr int kSides = 4096;  // circumscribed and inscribed polygons differ in area by 2 (π / 4096)² = 1.2e-6
      for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        light_.emplace_back(stage.light.radius * std::cos(angle), stage.light.radius * std::sin(angle));
      }
    } else if (stage.light.kind == visibility::LightKind::ellipse) {
      const auto [u, v] = maps::light_axes(stage.light, basis);
      for (int i = 0; i < 4096; ++i) {
        const double angle = 2 * std::numbers::pi * i / 4096;
        light_.push_back(std::cos(angle) * u + std::sin(angle) * v);
      }
    } else {
      for (const glm::vec3& corner : stage.light.outline) light_.emplace_back(basis.local(corner));
    }
  }
  [[nodiscard]] double visibility(std::size_t pixel) const { return 1 - hidden_of(light_, pixel) / area(light_); }
  /// V of a rectangle light with a texture: each texel is a separate light, weighted by its luminance.
  [[nodiscard]] double visibility(std::size_t pixel, const visibility::LightTexture& texture) const {
    const visibility::LightFrame frame = visibility::light_frame(stage_->light);
    double hidden = 0, whole = 0;
    for (std::uint32_t y = 0; y < texture.height; ++y) {
      for (std::uint32_t x = 0; x < texture.width; ++x) {
        std::vector<glm::dvec2> texel;
        for (const auto& [right, down] : {std::pair(0U, 1U), std::pair(1U, 1U), std::pair(1U, 0U), std::pair(0U, 0U)}) {
          const double s = -1 + 2.0 * (x + right) / texture.width, t = 1 - 2.0 * (y + down) / texture.height;
          texel.emplace_back(basis_.local(frame.center + s * frame.u + t * frame.v));
        }
        const double luminance = texture.luminance[y * texture.width + x];
        hidden += luminance * hidden_of(texel, pixel);
        whole += luminance * area(texel);
      }
    }
    return 1 - hidden / whole;
  }

 private:
  [[nodiscard]] double hidden_of(std::vector<glm::dvec2> seen, std::size_t pixel) const {
    const glm::dvec3 p = basis_.local(stage_->samples.p[pixel]);
    const double f = height_ * p.z / (p.z - height_);
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const glm::dvec2 a = (outline_[i] - glm::dvec2(p) / p.z) * f;
      const glm::dvec2 b = (outline_[(i + 1) % outline_.size()] - glm::dvec2(p) / p.z) * f;
      std::vector<glm::dvec2> inside;
      for (std::size_t k = 0; k < seen.size(); ++k) {
        const glm::dvec2 &s = seen[k], &t = seen[(k + 1) % seen.size()];
        const double left_s = cross(b - a, s - a), left_t = cross(b - a, t - a);
        if (left_s >= 0) inside.push_back(s);
        if ((left_s >= 0) != (left_t >= 0)) inside.push_back(s + (t - s) * (left_s / (left_s - left_t)));
      }
      seen = std::move(inside);
    }
    return area(seen);
  }
  static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
  static double area(const std::vector<glm::dvec2>& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return std::abs(twice) / 2;
  }
  const Stage* stage_;
  maps::LightBasis basis_;
  double height_ = 0;
  glm::dvec2 texel_{0};
  std::vector<glm::dvec2> outline_, light_;
};

}  // namespace penumbra::tests
