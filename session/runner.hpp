// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/process/progress.hpp"
#include "session/session.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Result of a method for one tile and one light, with the host's rules applied (see run_method).
struct TileResult {
  std::size_t light = 0;  ///< index into RunPlan::lights
  visibility::Tile tile;
  std::span<const float> visibility;     ///< V of each pixel of the tile; NaN: not evaluated (RunPlan::pixels)
  std::span<const std::uint32_t> masks;  ///< words_per_mask() words a pixel; empty for a method without masks
  /// For a light with translucent surfaces (visibility::FilteredMasks); else empty.
  std::span<const float> transmittances;
  std::span<const std::uint8_t> dimmed;
  /// Method::read_form_factors unchanged; empty unless the method's output is radiance. Pixels lit by a rule have none:
  /// beauty computes theirs.
  std::span<const glm::dvec3> form_factors;
};

/// Function called once for each tile of each light, in order, from the first run.
using TileSink = std::function<void(const TileResult&)>;

struct RunPlan {
  /// Lights as in Session::lights, possibly with other light samples; or without filtered_by: then V is NaN where a
  /// translucent surface or hole may be in between (Session::filtered). These view samples are evaluated nevertheless,
  /// so that their neighbours' digits do not depend on them.
  std::span<const visibility::Light> lights;
  bool filtered_alone = false;  ///< for a light with filtered_by, evaluate only those view samples; NaN elsewhere
  std::uint32_t runs = 1;       ///< largest number of timed runs
  /// Time limit for all timed runs: another run begins only if it would end in time when as long as the last one.
  double run_seconds = std::numeric_limits<double>::infinity();
  bool discard_first = false;  ///< one additional first run, as warm-up, which is not counted
  bool shades = false;         ///< form factors come with V, in the time of `evaluate` (Method::want_form_factors)
  std::optional<std::vector<std::uint32_t>> pixels = {};  ///< pixels to be evaluated (ascending); nullopt: every pixel
  /// For each light, each pixel, 1: none of the light's radiance arrives, and V is not read there. The method is not
  /// evaluated there, and V and masks are 0. Empty, or empty for a light: every pixel is evaluated.
  std::span<const std::vector<std::uint8_t>> dark = {};
  std::vector<std::size_t> only = {};  ///< lights to be evaluated (indices); empty: all
  /// Scene of the last run of this method, if unchanged: it is not prepared again.
  const visibility::SceneFloats* prepared = nullptr;
  /// Receives the method's scene as soon as it is prepared: also in a run that is not completed.
  const visibility::SceneFloats** holds = nullptr;
  /// Largest number of rows evaluated at once. Between bands, Progress may stop the run.
  std::uint32_t band_rows = std::numeric_limits<std::uint32_t>::max();
  /// Limit of a run's time. The discarded first run, which begins with tiles of a few rows, throws TakesTooLong if a
  /// whole run would exceed it.
  double most_seconds = std::numeric_limits<double>::infinity();
  std::string stage = {};  ///< label of the progress bar; empty: the method's name
};

/// Times of one light, medians if there were several runs.
struct LightTimes {
  double light = 0, evaluate = 0;
};

/// Times of one method over all lights, in seconds: medians if there were several runs.
struct RunTimes {
  double mesh = 0, light = 0, evaluate = 0;
  double view = 0;                 ///< of the first run: passing view samples to the method
  double read = 0;                 ///< of the first run: reading back, and sinks
  std::vector<LightTimes> lights;  ///< of each of the plan's lights; 0 if it was not evaluated
  /// Time of the discarded run's light + evaluate, less the medians, >= 0; with a limit (RunPlan::most_seconds) also
  /// less the estimated time of its additional tiles. Empty: no such run.
  std::optional<double> warmup;
  std::uint32_t runs = 0;  ///< timed runs
  double total = 0;        ///< wall-clock time of the whole call for this method, including reading back and
                           ///< sinks
};

struct MethodRun {
  RunTimes times;
  std::vector<std::vector<float>> visibility;  ///< for each evaluated light, V of each pixel; NaN: not evaluated
  std::vector<visibility::PassTime> passes;    ///< of the last run
  std::map<std::string, std::uint64_t> counters;
  std::uint64_t memory_bytes = 0;
  /// Options that the method changed itself (visibility::ChangesDefaults).
  visibility::MethodOptions changed_defaults;
  const visibility::SceneFloats* prepared = nullptr;  ///< the method's current scene (RunPlan::prepared)
};

/// Thrown by run_method between two tiles, after RunPlan::most_seconds, if a whole run would take longer than that.
struct TakesTooLong final : std::exception {
  double seconds = 0;  ///< of a whole run, as estimated from the rows that are done
  explicit TakesTooLong(double estimated) : seconds(estimated) {}
  [[nodiscard]] const char* what() const noexcept override { return "a method takes too long"; }
};

/// Adds the result of another method for other lights of the same plan, or for other pixels of the same lights.
void add_run(MethodRun& to, MethodRun&& other);

/// Runs a method on a session: mesh once, then light and tiles, and reads the first run's result. Applies the host's
/// rules, here for every method: background, pixels on the light's own body, and receivers with receivesShadow = false
/// are visible from every light sample, and receivers not lit by the light (a mesh's `lights`) from none. For a light
/// that only some objects shade, the method gets a scene in which only these cast. Translucent surfaces and holes are
/// applied to masks after the method (visibility::AlphaFilter), in the time of `evaluate`.
MethodRun run_method(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
                     Progress& progress);

}  // namespace penumbra::session
