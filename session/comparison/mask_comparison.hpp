// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/metrics.hpp"
#include "session/process/progress.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::session {

/// Pair of view sample and light sample on which a method and its reference differ.
struct DifferingPair {
  std::uint32_t pixel = 0, light_sample = 0;
  bool visible_for_method = false;
};

/// Masks to compare with.
struct MaskQuestion {
  std::size_t light = 0;                     ///< index into Session::lights
  std::span<const std::uint32_t> reference;  ///< masks of the whole image, on the light's samples; must outlive this
                                             ///< object
  std::size_t most_decided = 4000;           ///< number of differing pairs decided exactly
};

/// Counts, tile by tile, differences between the masks of a method and those of rays on the same light samples, and
/// keeps some of the differing pairs for exact decision: all while there are few, then evenly spaced ones.
class MaskComparison {
 public:
  /// `session` must outlive this object.
  MaskComparison(const Session& session, const MaskQuestion& question);

  /// Adds a tile of this light, with masks.
  void add(const TileResult& result);

  [[nodiscard]] const compare::PairCounts& counts() const { return counts_; }
  [[nodiscard]] const std::vector<DifferingPair>& kept() const { return kept_; }
  /// Returns whether the kept pairs are all differing pairs.
  [[nodiscard]] bool kept_all() const { return stride_ == 1; }

  /// Decides the kept pairs exactly and returns the verdicts. Takes milliseconds for each pair.
  [[nodiscard]] compare::PairVerdicts decide(Progress& progress) const;

 private:
  const Session& session_;
  MaskQuestion question_;
  compare::PairCounts counts_;
  std::vector<DifferingPair> kept_;
  std::uint64_t seen_ = 0, stride_ = 1;  ///< every stride-th differing pair in scan-line order is kept
};

}  // namespace penumbra::session
