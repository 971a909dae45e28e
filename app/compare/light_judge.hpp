#pragma once

#include "app/compare/mask_comparison.hpp"
#include "app/process/progress.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"
#include "app/whole_lights.hpp"
#include "compare/stats.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// How large shadows' parts are at each pixel; no number where that is not known. Empty: nowhere.
struct PenumbraSizes {
  std::vector<float> width;           ///< of the penumbra, across the light's normal, in scene floats
  std::vector<float> width_pixels;    ///< as many pixels wide, seen head-on from the camera
  std::vector<float> contact_pixels;  ///< so many pixels away is the nearest that hides some of the light
};

/// What is held against the methods under one of whole_lights.
struct LightTruth {
  std::vector<std::uint32_t> judged, horizon;  ///< pixels that errors are taken over
  std::vector<float> reference;                ///< V of each pixel
  compare::PixelClasses classes;               ///< of the judged ones, by the reference
  PenumbraSizes sizes;                         ///< of the shadowed ones
  std::vector<float> rays;                     ///< V of each pixel by rays on the methods' light samples; empty: none
  std::vector<std::vector<std::uint32_t>> ray_masks;  ///< of the same rays, of each piece; empty: none
};

/// For each of the session's whole lights the pixels that --sample-pixels chooses, and nothing else yet.
std::vector<LightTruth> choose_pixels(const Session& session, const std::string& sample_pixels);

/// All pixels of all lights, ascending.
std::vector<std::uint32_t> all_pixels(std::span<const LightTruth> truths);

/// Judges one method under every light, tile by tile as its results come, so that its masks need not be kept.
class LightJudge {
 public:
  /// `most_decided`: differing pairs a light that exact arithmetic looks at. All must outlive it.
  LightJudge(const Session& session, std::span<const LightTruth> truths, std::size_t most_decided);

  void add(const TileResult& tile);
  /// Once all tiles came. `run`: of whole lights.
  std::vector<compare::LightResult> judge(const MethodRun& run, Progress& progress);
  /// Errors and verdicts as metrics.json has them: light by light, of all lights, and of the first light again.
  void fill(compare::MethodResult& result, const MethodRun& run, bool pairs_of_reference, Progress& progress);
  /// LightResult::by_texels of the method's lights. `options`: all of them.
  void count_texels(std::span<compare::LightResult> results, const MethodRun& run,
                    const visibility::MethodDescription& description, const visibility::MethodOptions& options) const;

 private:
  const Session& session_;
  std::span<const LightTruth> truths_;
  std::vector<WholeLight> wholes_;                    ///< whose truths_ are
  std::vector<std::optional<MaskComparison>> masks_;  ///< of each of the session's lights
  bool has_masks_ = false;                            ///< the method's: known once its tiles came
};

/// V less V of the reference at each pixel; NaN where it is not judged.
std::vector<float> judged_errors(std::span<const float> visibility, const LightTruth& truth);

/// Over all lights' judged pixels together.
std::optional<compare::VisibilityError> error_of_all_lights(const MethodRun& run, std::span<const LightTruth> truths);

}  // namespace penumbra::app
