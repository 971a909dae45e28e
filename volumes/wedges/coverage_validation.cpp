// SPDX-License-Identifier: Apache-2.0
// Checks the invariant `coverage` (docs/coverage.md): the sums over silhouettes equal the sums over triangles, or lie
// between the exact area of the union and the sum of layers. Not from a paper.

#include "volumes/wedges/coverage_validation.hpp"

#include "volumes/wedges/layer_areas.hpp"

#include <fmt/format.h>

#include <tbb/parallel_for.h>

#include <cmath>

namespace penumbra::volumes {
namespace {

void count(ValidationReport& report) {
  ++report.checks[static_cast<std::size_t>(Invariant::coverage)];
}

void fail(const CoveragePoint& point, double distance, std::string what, ValidationReport& report) {
  report.violations.push_back({Invariant::coverage, {}, {}, glm::dvec3(point.sample.p), distance, std::move(what)});
}

}  // namespace

std::vector<CoveragePoint> check_coverage(const SoftVisibility& soft, const visibility::Light& light,
                                          std::span<const LitPoint> samples, ValidationReport& report) {
  std::vector<CoveragePoint> points(samples.size());
  const bool touching = soft.something_touches_light();
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    CoveragePoint& point = points[i];
    point.sample = samples[i];
    const auto layers = projected_layers(light, samples[i].p, soft.layers(samples[i]));
    point.touches_light = touching;
    if (soft.texture() != nullptr) point.tolerance *= soft.texture()->brightest();
    point.center = soft.at(samples[i], Viewer::center).blocked;
    point.receiver = soft.at(samples[i], Viewer::receiver).blocked;
    point.layers = sum_of_layers(soft.outline(), layers, soft.texture());
    point.overlap = overlap_of_layers(soft.outline(), layers, kMostOverlap, soft.texture());
  });
  for (const CoveragePoint& point : points) {
    if (point.touches_light) continue;
    count(report);
    const double off = std::abs(point.receiver - point.layers);
    if (off <= point.tolerance) continue;
    fail(point, off,
         fmt::format("the receiver's silhouettes hide {} of the light, its triangles {}", point.receiver, point.layers),
         report);
  }
  return points;
}

void check_union(const CoveragePoint& point, double hidden, double error, ValidationReport& report) {
  if (point.touches_light) return;
  count(report);
  const double more = point.receiver - hidden, tolerance = point.tolerance + error;
  const bool bounded = point.overlap <= kMostOverlap;
  if (more >= -tolerance && (!bounded || more <= point.overlap + tolerance)) return;
  fail(point, more < 0 ? -more : more - point.overlap,
       fmt::format("the receiver's silhouettes hide {} of the light, the exact union {}, and layers overlap by {}",
                   point.receiver, hidden, point.overlap),
       report);
}

}  // namespace penumbra::volumes
