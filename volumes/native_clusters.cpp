#include "volumes/native_clusters.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes::native {
namespace {

float size1(const glm::vec3& x) {
  return std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
}

constexpr std::size_t kMostClusters = 4;

/// In the middle of the box's longest side, if a gap of more than a third of it is there.
bool split(std::vector<Sample>& samples, std::vector<Sample>& rest) {
  glm::vec3 lower(samples.front().p), upper(lower);
  for (const Sample& at : samples) {
    lower = glm::min(lower, at.p);
    upper = glm::max(upper, at.p);
  }
  const glm::vec3 size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float cut = 0.5F * lower[axis] + 0.5F * upper[axis];
  float below = lower[axis], above = upper[axis];
  for (const Sample& at : samples) {
    if (at.p[axis] < cut) below = std::max(below, at.p[axis]);
    if (at.p[axis] >= cut) above = std::min(above, at.p[axis]);
  }
  if (!(above - below > 0.34F * size[axis])) return false;
  const auto middle =
      std::stable_partition(samples.begin(), samples.end(), [&](const Sample& at) { return at.p[axis] < cut; });
  rest.assign(middle, samples.end());
  samples.erase(middle, samples.end());
  return !rest.empty() && !samples.empty();
}

Cluster cluster_of(const Frame& frame, const std::vector<Sample>& samples) {
  glm::vec3 lower(samples.front().p), upper(lower);
  for (const Sample& at : samples) {
    lower = glm::min(lower, at.p);
    upper = glm::max(upper, at.p);
  }
  Cluster cluster;
  cluster.middle = 0.5F * lower + 0.5F * upper;
  cluster.half_size = glm::max(upper - cluster.middle, cluster.middle - lower) * (1 + 8 * kRound);
  cluster.samples.reserve(samples.size());
  for (const Sample& at : samples) {
    Sample sample = at;
    sample.local = at.p - cluster.middle;
    // As dot() of native_find.cpp: one order, nothing fused.
    const auto dot = [&](const glm::vec3& n) {
      return (sample.local.x * n.x + sample.local.y * n.y) + sample.local.z * n.z;
    };
    sample.seen = {dot(frame.across), dot(frame.along), dot(frame.axis)};
    sample.far = glm::length(sample.local) * 1.0001F;
    cluster.samples.push_back(sample);
  }
  return cluster;
}

}  // namespace

Looked look(const ViewInput& view, std::uint32_t pixel) {
  const auto& [scene, samples, light, frame, normal_is_known, scale] = view;
  const std::int32_t carrier = samples.triangle[pixel];
  if (carrier == visibility::ViewSamples::kBackground) return {};
  const auto triangle = static_cast<std::uint32_t>(carrier);
  if (scene.receives_shadow[triangle] == 0) return {};
  Looked looked;
  Sample& at = looked.sample;
  at.p = samples.p[pixel] * scale;
  const glm::vec3 from = at.p - frame.center;
  at.pixel = pixel;
  at.plane = scene.plane[triangle];
  at.height = glm::dot(frame.axis, from);
  // (bound level)
  const float error_level = 16 * kRound * frame.skew * (size1(from) + size1(at.p)) + frame.deviation;
  if (std::abs(at.height) <= error_level) return {Outlook::open, at};
  if (at.height < 0) return {Outlook::elsewhere, at};
  at.foot = glm::vec2(glm::dot(frame.across, from), glm::dot(frame.along, from)) + frame.first_cell;
  // (bound horizon)
  const glm::vec3 normal = normal_is_known[triangle] != 0 ? samples.n[pixel] : glm::vec3(0);
  at.above = {glm::dot(normal, light.u), glm::dot(normal, light.v), -glm::dot(normal, from)};
  at.above_error = 16 * kRound * (size1(from) + size1(light.u) + size1(light.v) + size1(at.p)) + frame.deviation;
  const float span = std::abs(at.above.x) + std::abs(at.above.y);
  if (at.above.z + span < -at.above_error) return {Outlook::none, at};
  at.straddles = at.above.z - span <= at.above_error;
  looked.outlook = Outlook::scattered;
  return looked;
}

std::vector<Cluster> make_clusters(const Frame& frame, std::vector<Sample> samples) {
  std::vector<std::vector<Sample>> parts;
  if (samples.empty()) return {};
  parts.push_back(std::move(samples));
  for (std::size_t i = 0; i < parts.size() && parts.size() < kMostClusters;) {
    std::vector<Sample> rest;
    if (split(parts[i], rest)) {
      parts.push_back(std::move(rest));
    } else {
      ++i;
    }
  }
  std::vector<Cluster> clusters;
  clusters.reserve(parts.size());
  for (const std::vector<Sample>& part : parts) clusters.push_back(cluster_of(frame, part));
  return clusters;
}

}  // namespace penumbra::volumes::native
