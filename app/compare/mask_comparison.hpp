#pragma once

#include "app/process/progress.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"
#include "compare/metrics.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::app {

/// One pair of view sample and light sample on which a method and its reference differ.
struct DifferingPair {
  std::uint32_t pixel = 0, light_sample = 0;
  bool visible_for_method = false;
};

/// What masks are compared with.
struct MaskQuestion {
  std::size_t light = 0;                     ///< index into Session::lights
  std::span<const std::uint32_t> reference;  ///< masks of the whole image, on the light's samples; must outlive all
  std::size_t most_decided = 4000;           ///< differing pairs that are decided exactly
};

/// Counts, tile by tile, where the masks of a method differ from those of rays on the same light samples, and keeps
/// some of the differing pairs for exact decision: all of them while there are few, then evenly spaced ones.
class MaskComparison {
 public:
  /// `session` must outlive it.
  MaskComparison(const Session& session, const MaskQuestion& question);

  /// For tiles of that light, with masks.
  void add(const TileResult& result);

  [[nodiscard]] const compare::PairCounts& counts() const { return counts_; }
  [[nodiscard]] const std::vector<DifferingPair>& kept() const { return kept_; }
  /// Are these all differing pairs?
  [[nodiscard]] bool kept_all() const { return stride_ == 1; }

  /// Who was right on the kept pairs: the exact pair decision says. Milliseconds each.
  [[nodiscard]] compare::PairVerdicts decide(Progress& progress) const;

 private:
  const Session& session_;
  MaskQuestion question_;
  compare::PairCounts counts_;
  std::vector<DifferingPair> kept_;
  std::uint64_t seen_ = 0, stride_ = 1;  ///< every stride-th differing pair in scan-line order is kept
};

}  // namespace penumbra::app
