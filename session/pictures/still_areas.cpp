// SPDX-License-Identifier: Apache-2.0
// Reuses exact areas from one moment of a picture to the next where the surface and the light are at rest and no
// moving triangle can be between them. Moving triangles are held in at most 64 boxes, enlarged by far more than
// rounding.

#include "session/pictures/still_areas.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::Bounds;
using visibility::Light;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

/// Limit above which more boxes are not worth their tests: one box then holds all.
constexpr std::size_t kMostBoxes = 64;

bool same_surfaces(const SceneFloats& a, const SceneFloats& b) {
  return a.origin == b.origin && a.object == b.object && a.casts_shadow == b.casts_shadow &&
         a.receives_shadow == b.receives_shadow && a.emits == b.emits && a.alphas.empty() && b.alphas.empty();
}

/// Returns whether the two lights are the same in all that V depends on; false for lights with pictures, where this is
/// unknown.
bool same_light(const Light& a, const Light& b) {
  const auto of = [](const Light& light) {
    return std::tie(light.index, light.piece, light.kind, light.two_sided, light.center, light.center_u, light.center_v,
                    light.outline, light.radius, light.unshaded_by, light.unlit, light.filtered_by);
  };
  const auto is_plain = [](const Light& light) { return !light.texture && !light.dome && !light.sun; };
  return is_plain(a) && is_plain(b) && of(a) == of(b);
}

Bounds box_of(const Light& light) {
  if (light.outline.empty()) {
    const glm::vec3 half(static_cast<float>(light.radius));
    return {light.center - half, light.center + half};
  }
  Bounds box{light.outline.front(), light.outline.front()};
  for (const glm::vec3& corner : light.outline) {
    box.lower = glm::min(box.lower, corner);
    box.upper = glm::max(box.upper, corner);
  }
  return box;
}

/// Returns whether a segment from p to any point in a box may meet another box. Along each axis, at each parameter t,
/// the segments lie between two coordinates; the intervals of t within the other box must overlap on all three axes.
bool may_meet(const glm::vec3& p, const Bounds& to, const Bounds& box) {
  double first = 0, last = 1;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    const double from = double{p[axis]}, low = double{to.lower[axis]} - from, high = double{to.upper[axis]} - from;
    // Solves from + t · high ≥ lower, and from + t · low ≤ upper.
    const double up = double{box.lower[axis]} - from, down = double{box.upper[axis]} - from;
    if (high > 0)
      first = std::max(first, up / high);
    else if (high < 0)
      last = std::min(last, up / high);
    else if (up > 0)
      return false;
    if (low > 0)
      last = std::min(last, down / low);
    else if (low < 0)
      first = std::max(first, down / low);
    else if (down < 0)
      return false;
  }
  return first <= last;
}

}  // namespace

MovedParts::MovedParts(const SceneFloats& before, const SceneFloats& now) {
  is_known_ = same_surfaces(before, now);
  if (!is_known_) return;
  moved_.resize(now.triangles.size());
  tbb::parallel_for(std::size_t{0}, moved_.size(), [&](std::size_t i) {
    const auto triangle = static_cast<std::uint32_t>(i);
    moved_[i] = before.corners(triangle) != now.corners(triangle) ? 1 : 0;
  });
  std::map<std::uint32_t, Bounds> of_objects;
  for (std::uint32_t triangle = 0; triangle < moved_.size(); ++triangle) {
    if (moved_[triangle] == 0) continue;
    Bounds& box =
        of_objects.try_emplace(now.object[triangle], Bounds{now.corners(triangle)[0], now.corners(triangle)[0]})
            .first->second;
    for (const SceneFloats* scene : {&before, &now}) {
      for (const glm::vec3& corner : scene->corners(triangle)) {
        box.lower = glm::min(box.lower, corner);
        box.upper = glm::max(box.upper, corner);
      }
    }
  }
  // Methods search slightly beyond surfaces because of rounding: by far less than this margin.
  const glm::vec3 size = glm::max(now.upper, before.upper) - glm::min(now.lower, before.lower);
  const glm::vec3 more(0x1p-12F * std::max({size.x, size.y, size.z}));
  for (const auto& [object, box] : of_objects) boxes_.push_back({box.lower - more, box.upper + more});
  if (boxes_.size() <= kMostBoxes) return;
  Bounds all = boxes_.front();
  for (const Bounds& box : boxes_) all = {glm::min(all.lower, box.lower), glm::max(all.upper, box.upper)};
  boxes_ = {all};
}

bool MovedParts::may_hide(const glm::vec3& p, const Light& light) const {
  const Bounds to = box_of(light);
  return !is_known_ || std::ranges::any_of(boxes_, [&](const Bounds& box) { return may_meet(p, to, box); });
}

bool StillMoments::are_worth(std::size_t view_samples, std::size_t lights) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  return view_samples * lights <= kMostBytes / (2 * sizeof(AreaAnswer));
}

void StillMoments::begin(const SceneFloats& floats) {
  moved = floats_ ? MovedParts(*floats_, floats) : MovedParts();
  floats_ = floats;
  before = std::exchange(now, {});
}

StillAreas::StillAreas(visibility::Method& method, StillMoments& moments, std::span<const Light> lights)
    : AskedAreas(method), moments_(moments), lights_(lights) {
  moments_.now.lights.assign(lights.begin(), lights.end());
  moments_.now.answers.resize(lights.size());
}

void StillAreas::prepare_light(const Light& light) {
  AskedAreas::prepare_light(light);
  light_ = static_cast<std::size_t>(&light - lights_.data());
  PENUMBRA_ASSERT(light_ < lights_.size(), "light \"{}\" is none of these", light.name);
  const StillAnswers& before = moments_.before;
  is_known_ =
      light_ < before.lights.size() && !before.answers[light_].empty() && same_light(before.lights[light_], light);
}

void StillAreas::prepare_view(const ViewSamples& samples) {
  AskedAreas::prepare_view(samples);
  if (moments_.now.samples.size() == 0) moments_.now.samples = samples;
}

bool StillAreas::is_still(std::size_t sample) const {
  const ViewSamples &was = moments_.before.samples, &is = samples();
  const std::int32_t triangle = is.triangle[sample];
  return was.triangle[sample] == triangle && was.p[sample] == is.p[sample] && was.n[sample] == is.n[sample] &&
         was.facing[sample] == is.facing[sample] && !moments_.moved.has(static_cast<std::size_t>(triangle)) &&
         !moments_.moved.may_hide(is.p[sample], lights_[light_]);
}

std::vector<std::size_t> StillAreas::answer(const Tile& tile, std::span<AreaAnswer> answers) {
  const ViewSamples& all = samples();
  const StillAnswers& before = moments_.before;
  const bool is_known = is_known_ && before.samples.width == all.width && before.samples.height == all.height;
  const std::size_t first = std::size_t{tile.first_row} * all.width;
  std::vector<std::uint8_t> is_open(answers.size());
  tbb::parallel_for(std::size_t{0}, answers.size(), [&](std::size_t i) {
    if (all.triangle[first + i] == ViewSamples::kBackground) return;
    if (is_known && is_still(first + i))
      answers[i] = before.answers[light_][first + i];
    else
      is_open[i] = 1;
  });
  std::vector<std::size_t> open = in_regions(all.width, tile.row_count);
  const auto still = static_cast<std::uint64_t>(std::erase_if(open, [&](std::size_t i) { return is_open[i] == 0; }));
  std::uint64_t background = 0;
  for (std::size_t i = 0; i < answers.size(); ++i)
    background += all.triangle[first + i] == ViewSamples::kBackground ? 1 : 0;
  count("viewSamplesStill", still - background);
  return open;
}

void StillAreas::keep(const Tile& tile, std::span<const AreaAnswer> answers) {
  std::vector<AreaAnswer>& all = moments_.now.answers[light_];
  all.resize(samples().size());
  std::ranges::copy(answers, all.begin() + static_cast<std::ptrdiff_t>(std::size_t{tile.first_row} * samples().width));
}

}  // namespace penumbra::session
