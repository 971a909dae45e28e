// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/soft_visibility.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <span>
#include <vector>

namespace penumbra::volumes {

/// Largest permitted error of the summed coverage where the sum must be exact: far above the rounding error (1e-14
/// measured, docs/coverage.md), far below the change from one wrong edge on a visible part of the light. A limit stated
/// by `wedges --validate`, not a proved bound.
inline constexpr double kCoverageTolerance = 1e-6;
/// Layers that overlap by less than this fraction of the light count as a single layer: a tenth of the tolerance.
inline constexpr double kSingleLayer = 1e-7;

/// Sums of one view sample and the values they are checked against.
struct CoveragePoint {
  LitPoint sample;
  double center = 0, receiver = 0;  ///< `blocked` from the silhouettes of the centre and of the receiver
  double layers = 0;                ///< `blocked` of the receiver, summed triangle by triangle (layer_areas.hpp)
  double overlap = 0;               ///< overlap of the layers; the summation stopped once it was beyond `kMostOverlap`
  double tolerance = kCoverageTolerance;
  bool touches_light = false;  ///< a caster meets the light itself: no check applies to this sample

  [[nodiscard]] bool is_single_layer() const { return !touches_light && overlap <= kSingleLayer; }
};
inline constexpr double kMostOverlap = 4;

/// Checks the invariant `coverage` (f): the receiver's silhouettes add up to its layers, to kCoverageTolerance, at each
/// sample; samples must be in front of the light (asserted). The difference of the centre's sum is only reported. Runs
/// in parallel; violations are added in the order of samples. At each sample, a sphere is the disk visible from there.
/// For a textured light, areas are weights, and the tolerance grows by the ratio of the brightest texel to the mean.
std::vector<CoveragePoint> check_coverage(const SoftVisibility& soft, const visibility::Light& light,
                                          std::span<const LitPoint> samples, ValidationReport& report);

/// Checks the invariant `coverage` against `hidden`, the exact area of the union as computed by the caller: the sum is
/// at least `hidden` and at most point.overlap more; for a single layer therefore equal to `hidden`. `error` bounds the
/// error of `hidden`.
void check_union(const CoveragePoint& point, double hidden, double error, ValidationReport& report);

}  // namespace penumbra::volumes
