#pragma once

#include "volumes/wedges/soft_visibility.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <span>
#include <vector>

namespace penumbra::volumes {

/// What the summed coverage may be off by where it must be exact: far above what rounding adds (1e-14 measured,
/// docs/coverage.md), far below what one wrong edge changes on a visible part of the light. Not a bound but a limit
/// that `wedges --validate` states.
inline constexpr double kCoverageTolerance = 1e-6;
/// Layers that overlap by less of the light are taken for a single one: a tenth of the tolerance.
inline constexpr double kSingleLayer = 1e-7;

/// One view sample's sums, and what they are held against.
struct CoveragePoint {
  LitPoint sample;
  double center = 0, receiver = 0;  ///< `blocked` by the centre's silhouettes, by the receiver's own
  double layers = 0;                ///< the receiver's `blocked`, summed triangle by triangle (layer_areas.hpp)
  double overlap = 0;               ///< of layers; beyond `kMostOverlap` it was not summed further
  double tolerance = kCoverageTolerance;
  bool touches_light = false;  ///< something meets the light itself: nothing is held against anything

  [[nodiscard]] bool is_single_layer() const { return !touches_light && overlap <= kSingleLayer; }
};
inline constexpr double kMostOverlap = 4;

/// Invariant `coverage` (f): the receiver's silhouettes add up to its layers, to kCoverageTolerance, at each sample,
/// which must be in front of the light (asserted). The difference of the centre's is only told. Parallel; violations
/// are added in the order of samples. A sphere is at each sample the disk that it sees. Under a texture areas are
/// weights, and the tolerance grows by how much brighter than the mean its brightest texel is.
std::vector<CoveragePoint> check_coverage(const SoftVisibility& soft, const visibility::Light& light,
                                          std::span<const LitPoint> samples, ValidationReport& report);

/// Checks the invariant `coverage` against the exact area of the union, `hidden`, which the caller knows: the sum is at
/// least that and at most `overlap` more; so for a single layer equal to it. `error` bounds that of `hidden` itself.
void check_union(const CoveragePoint& point, double hidden, double error, ValidationReport& report);

}  // namespace penumbra::volumes
