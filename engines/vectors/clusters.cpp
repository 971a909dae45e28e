// SPDX-License-Identifier: Apache-2.0
// Classifies view samples against the light, and splits blocks of pixels into clusters.

#include "engines/vectors/clusters.hpp"

#include "base/size1.hpp"
#include "visibility/receivers.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace penumbra::vectors {
namespace {

constexpr std::size_t kMostClusters = 4;

/// Returns the split position: the middle of the box's longest side if there is a gap of more than a third of it; else
/// the end.
std::size_t split(std::span<GridSample> samples) {
  glm::vec3 lower(samples.front().p), upper(lower);
  for (const GridSample& at : samples) {
    lower = glm::min(lower, at.p);
    upper = glm::max(upper, at.p);
  }
  const glm::vec3 size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float cut = 0.5F * lower[axis] + 0.5F * upper[axis];
  float below = lower[axis], above = upper[axis];
  for (const GridSample& at : samples) {
    const float x = at.p[axis];
    below = x < cut ? std::max(below, x) : below;
    above = x < cut ? above : std::min(above, x);
  }
  if (!(above - below > 0.34F * size[axis])) return samples.size();
  const auto middle =
      std::stable_partition(samples.begin(), samples.end(), [&](const GridSample& at) { return at.p[axis] < cut; });
  return static_cast<std::size_t>(middle - samples.begin());
}

}  // namespace

bool KnownNormals::is_known(std::uint32_t triangle) const {
  const std::atomic_ref answer(answers_[triangle]);
  Answer found = answer.load(std::memory_order_relaxed);
  if (found == Answer::not_asked) {  // if two threads compute an answer at once, both get the same
    found = visibility::normal_is_known(scene_->corners(triangle)) ? Answer::known : Answer::unknown;
    answer.store(found, std::memory_order_relaxed);
  }
  return found == Answer::known;
}

SampleClass classify(const ViewInput& view, std::uint32_t pixel, GridSample& at) {
  const auto& [scene, samples, light, grid, normals, scale] = view;
  if (!visibility::is_receiver(scene, static_cast<std::int32_t>(grid.light), samples, pixel))
    return SampleClass::all_visible;
  const auto triangle = static_cast<std::uint32_t>(samples.triangle[pixel]);
  at.p = samples.p[pixel] * scale;
  const glm::vec3 from = at.p - grid.center;
  at.pixel = pixel;
  at.plane = scene.plane[triangle];
  at.height = glm::dot(grid.axis, from);
  // Error of the height: (bound level) of docs/edge-scatter.md.
  const float error_level = 16 * kRound * grid.skew * (size1(from) + size1(at.p)) + grid.deviation;
  if (std::abs(at.height) <= error_level) return SampleClass::open;
  if (at.height < 0) return SampleClass::other_side;
  at.foot = glm::vec2(glm::dot(grid.across, from), glm::dot(grid.along, from)) + grid.first_cell;
  // Error of the horizon: (bound horizon) of docs/edge-scatter.md.
  const glm::vec3 normal = normals.is_known(triangle) ? samples.n[pixel] : glm::vec3(0);
  at.above = {glm::dot(normal, light.u), glm::dot(normal, light.v), -glm::dot(normal, from)};
  at.above_error = 16 * kRound * (size1(from) + size1(light.u) + size1(light.v) + size1(at.p)) + grid.deviation;
  const float span = std::abs(at.above.x) + std::abs(at.above.y);
  if (at.above.z + span < -at.above_error) return SampleClass::none_visible;
  at.straddles = at.above.z - span <= at.above_error;
  return SampleClass::in_front;
}

std::vector<std::size_t> split_at_gaps(std::span<GridSample> samples) {
  std::vector<std::size_t> ends{samples.size()};
  for (std::size_t part = 0, begin = 0; part < ends.size() && ends.size() < kMostClusters;) {
    const std::size_t end = begin + split(samples.subspan(begin, ends[part] - begin));
    if (end > begin && end < ends[part]) {
      ends.insert(ends.begin() + static_cast<std::ptrdiff_t>(part), end);
    } else {
      begin = ends[part++];
    }
  }
  return ends;
}

}  // namespace penumbra::vectors
