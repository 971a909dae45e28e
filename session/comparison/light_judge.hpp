// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/stats.hpp"
#include "session/comparison/mask_comparison.hpp"
#include "session/process/progress.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "session/whole_lights.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Sizes of shadows' parts at each pixel; NaN where unknown. Empty: unknown everywhere.
struct PenumbraSizes {
  std::vector<float> width;           ///< of the penumbra, across the light's normal, in scene floats
  std::vector<float> width_pixels;    ///< the same in pixels, seen head-on from the camera
  std::vector<float> contact_pixels;  ///< distance, in pixels, of the nearest object that hides some of the light
};

/// Data with which methods are compared under one light of whole_lights().
struct LightTruth {
  std::vector<std::uint32_t> judged, horizon;  ///< pixels over which errors are computed
  std::vector<float> reference;                ///< V of each pixel
  compare::PixelClasses classes;               ///< of the judged pixels, by the reference
  PenumbraSizes sizes;                         ///< of the shadowed pixels
  std::vector<float> rays;                     ///< V of each pixel by rays on the methods' light samples; empty: not
                                               ///< computed
  std::vector<std::vector<std::uint32_t>> ray_masks;  ///< of the same rays, of each piece; empty: not computed
};

/// Returns, for each of the session's whole lights, the pixels chosen by --sample-pixels; other members are empty.
std::vector<LightTruth> choose_pixels(const Session& session, const std::string& sample_pixels);

/// Returns all pixels of all lights, ascending.
std::vector<std::uint32_t> all_pixels(std::span<const LightTruth> truths);

/// Judges one method under every light, tile by tile as results arrive, so that masks need not be kept.
class LightJudge {
 public:
  /// `most_decided`: number of differing pairs of a light decided by exact arithmetic. All arguments must outlive this
  /// object.
  LightJudge(const Session& session, std::span<const LightTruth> truths, std::size_t most_decided);

  void add(const TileResult& tile);
  /// Returns the results; valid after all tiles. `run`: of whole lights.
  std::vector<compare::LightResult> judge(const MethodRun& run, Progress& progress);
  /// Fills in errors and verdicts of metrics.json: light by light, of all lights, and of the first light again.
  void fill(compare::MethodResult& result, const MethodRun& run, bool pairs_of_reference, Progress& progress);
  /// Computes LightResult::by_texels of the method's lights. `options`: complete options.
  void count_texels(std::span<compare::LightResult> results, const MethodRun& run,
                    const visibility::MethodDescription& description, const visibility::MethodOptions& options) const;

 private:
  const Session& session_;
  std::span<const LightTruth> truths_;
  std::vector<WholeLight> wholes_;                    ///< lights of truths_
  std::vector<std::optional<MaskComparison>> masks_;  ///< of each of the session's lights
  bool has_masks_ = false;                            ///< the method has masks: known after its tiles
};

/// Returns V less V of the reference at each pixel; NaN for pixels that are not judged.
std::vector<float> judged_errors(std::span<const float> visibility, const LightTruth& truth);

/// Returns the error over all lights' judged pixels together.
std::optional<compare::VisibilityError> error_of_all_lights(const MethodRun& run, std::span<const LightTruth> truths);

}  // namespace penumbra::session
