// SPDX-License-Identifier: Apache-2.0
// Counts differing pairs and samples them evenly for exact decisions.

#include "session/comparison/mask_comparison.hpp"

#include "visibility/pair_truth.hpp"

namespace penumbra::session {

MaskComparison::MaskComparison(const Session& session, const MaskQuestion& question)
    : session_(session), question_(question) {}

void MaskComparison::add(const TileResult& result) {
  const visibility::Light& light = session_.lights[question_.light];
  const std::size_t first = std::size_t{result.tile.first_row} * session_.width;
  const std::size_t count = std::size_t{result.tile.row_count} * session_.width;
  std::vector<std::uint32_t> pixels;  // pixels of the tile that show a surface
  for (std::size_t i = 0; i < count; ++i) {
    if (session_.samples.triangle[first + i] != visibility::ViewSamples::kBackground) {
      pixels.push_back(static_cast<std::uint32_t>(i));
    }
  }
  const std::size_t words = light.words_per_mask();
  const compare::MaskPair masks{result.masks, question_.reference.subspan(first * words, count * words),
                                light.sample_count()};
  counts_ += compare::count_pairs(masks, pixels);
  compare::for_each_differing_pair(masks, pixels, [&](std::uint32_t pixel, std::uint32_t sample, bool visible) {
    if (seen_++ % stride_ != 0) return;
    kept_.push_back({static_cast<std::uint32_t>(first) + pixel, sample, visible});
    if (kept_.size() <= question_.most_decided) return;
    // There are too many pairs: keeps every second one, and from now on adds only half as many.
    stride_ *= 2;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
    kept_.resize((kept_.size() + 1) / 2);
  });
}

compare::PairVerdicts MaskComparison::decide(Progress& progress) const {
  compare::PairVerdicts verdicts;
  if (kept_.empty()) return verdicts;
  progress.begin("deciding pairs exactly", kept_.size());
  for (const DifferingPair& pair : kept_) {
    const visibility::PairTruth truth =
        visibility::decide_pair(session_.floats_for(question_.light), session_.samples, pair.pixel,
                                session_.lights[question_.light], pair.light_sample);
    const bool visible = truth.outcome == visibility::PairOutcome::visible;
    ++verdicts.decided;
    ++(visible == pair.visible_for_method ? verdicts.method_right : verdicts.reference_right);
    if (truth.zero_predicate) ++verdicts.zero_predicate;
    progress.advance();
  }
  return verdicts;
}

}  // namespace penumbra::session
