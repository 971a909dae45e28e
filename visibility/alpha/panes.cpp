#include "visibility/alpha/panes.hpp"

#include "base/assert.hpp"
#include "visibility/tree/view_walk.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace penumbra::visibility {

namespace {

/// Do a ray through their common edge or corner and cover(), which is of closed triangles, meet one surface twice?
bool are_one(const SceneFloats& scene, const ViewWalk::Met& a, const ViewWalk::Met& b) {
  if (scene.object[a.triangle] != scene.object[b.triangle] || !(b.t - a.t <= 0x1p-40 * b.t)) return false;
  const auto others = scene.corners(b.triangle);
  return std::ranges::any_of(scene.corners(a.triangle), [&](const glm::vec3& corner) {
    return std::ranges::find(others, corner) != others.end();
  });
}

}  // namespace

Panes::Panes(const SceneFloats& scene, const ViewSamples& seen) : scene_(scene), camera_(seen.camera) {
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
        if (k > 0 && are_one(scene, met[k - 1], met[k])) continue;
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
