// SPDX-License-Identifier: Apache-2.0
// Layers of translucent surfaces in front of each pixel's carrier.

#include "visibility/alpha/panes.hpp"

#include "base/assert.hpp"
#include "visibility/tree/view_walk.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace penumbra::visibility {

namespace {

/// Fractions or distances below this are rounding: both result from about ten operations in double.
constexpr double kNothing = 0x1p-40;

/// Returns whether hits a and b are one surface: a ray through a common edge or corner of two triangles meets both,
/// since cover() uses closed triangles. Coinciding triangles are two surfaces.
bool are_one(const SceneFloats& scene, const ViewRay& ray, const ViewWalk::Met& a, const ViewWalk::Met& b) {
  if (!(std::abs(b.t - a.t) <= kNothing * std::abs(b.t))) return false;
  const auto common = [](const std::array<glm::vec3, 3>& corners, const std::array<glm::vec3, 3>& others,
                         std::size_t i) { return std::ranges::find(others, corners[i]) != others.end(); };
  const auto crossed_at_common = [&](const std::array<glm::vec3, 3>& corners, const std::array<glm::vec3, 3>& others) {
    const glm::dvec3 shares = shares_on_line(ray.start, ray.direction, corners);
    std::size_t of_both = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (common(corners, others, i))
        ++of_both;
      else if (!(std::abs(shares[static_cast<glm::length_t>(i)]) <= kNothing))
        return false;
    }
    return of_both == 1 || of_both == 2;
  };
  const auto first = scene.corners(a.triangle), second = scene.corners(b.triangle);
  return crossed_at_common(first, second) && crossed_at_common(second, first);
}

}  // namespace

Panes::Panes(const SceneFloats& scene, const ViewSamples& seen) : scene_(scene), camera_(seen.camera) {
  const auto blends = [](const SurfaceAlphas::Surface& one) { return one.alpha.mode == scenes::Alpha::Mode::blend; };
  if (std::ranges::none_of(scene.alphas.surfaces, blends)) return;
  std::vector<std::uint32_t> blend;
  for (const std::uint32_t triangle : triangles_with_area(scene)) {
    if (alpha_mode(scene, triangle) == scenes::Alpha::Mode::blend) blend.push_back(triangle);
  }
  if (blend.empty()) return;
  const ViewWalk walk(scene, camera_, std::move(blend));
  panes_.resize(seen.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, seen.size(), 64), [&](const auto& range) {
    std::vector<ViewWalk::Met> met;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto x = static_cast<std::uint32_t>(i % seen.width), y = static_cast<std::uint32_t>(i / seen.width);
      const ViewRay ray = camera_.ray(x, y);
      double end = std::numeric_limits<double>::infinity();
      if (const std::int32_t carrier = seen.triangle[i]; carrier != ViewSamples::kBackground)
        end = cover(ray, scene.corners(static_cast<std::uint32_t>(carrier))).value_or(end);
      walk.meet(x, y, met);
      for (std::size_t k = 0; k < met.size() && met[k].t < end; ++k) {
        const std::uint32_t triangle = met[k].triangle;
        const std::span<const ViewWalk::Met> nearer(met.data(), k);
        if (std::ranges::any_of(nearer, [&](const auto& other) { return are_one(scene, ray, other, met[k]); }))
          continue;
        const glm::dvec3 shares = shares_on_line(ray.start, ray.direction, scene.corners(triangle));
        const double alpha = alpha_at(scene, triangle, shares);
        if (alpha > 0) panes_[i].push_back({static_cast<std::int32_t>(triangle), static_cast<float>(alpha)});
      }
    }
  });
  for (const std::vector<Pane>& pixel : panes_) depth_ = std::max(depth_, pixel.size());
}

PaneLayer Panes::layer(std::size_t number) const {
  PENUMBRA_ASSERT(number < depth_, "layer {} of {}", number, depth_);
  std::vector<std::int32_t> carriers(panes_.size(), ViewSamples::kBackground);
  std::vector<float> alpha(panes_.size(), 0.0F);
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    if (number >= panes_[i].size()) continue;
    carriers[i] = panes_[i][number].triangle;
    alpha[i] = panes_[i][number].alpha;
  }
  return {complete_view_samples(scene_, camera_, std::move(carriers)), std::move(alpha)};
}

}  // namespace penumbra::visibility
