#pragma once

#include "app/process/progress.hpp"
#include "app/session.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// What a method made of one tile for one light, with the host's rules applied (see run_method).
struct TileResult {
  std::size_t light = 0;  ///< index into RunPlan::lights
  visibility::Tile tile;
  std::span<const float> visibility;     ///< V of each pixel of the tile; NaN: not evaluated (RunPlan::pixels)
  std::span<const std::uint32_t> masks;  ///< words_per_mask() words a pixel; empty for a method without masks
  /// Of a light that meets translucent surfaces (visibility::FilteredMasks); else empty.
  std::span<const float> transmittances;
  std::span<const std::uint8_t> dimmed;
  /// Method::read_form_factors as read; empty unless the method's output is radiance. Pixels that lie in the light by
  /// rule have none: beauty knows theirs.
  std::span<const glm::dvec3> form_factors;
};

/// Gets each tile of each light once, in order, from the first run.
using TileSink = std::function<void(const TileResult&)>;

struct RunPlan {
  /// As in Session::lights, perhaps with other light samples; or without filtered_by: then V is NaN where what lets
  /// light through may be on the way (Session::filtered). Those view samples are evaluated all the same, so that no
  /// digit of their neighbours' depends on them.
  std::span<const visibility::Light> lights;
  bool filtered_alone = false;  ///< of a light with filtered_by, those view samples alone; else NaN
  std::uint32_t runs = 1;       ///< the most timed runs
  double run_seconds = std::numeric_limits<double>::infinity();  ///< no other run begins once these are over
  bool discard_first = false;  ///< one more before them, which warms up and does not count
  bool shades = false;         ///< form factors come with V, in the time of `evaluate` (Method::want_form_factors)
  std::optional<std::vector<std::uint32_t>> pixels =
      {};                              ///< all that will be looked at (ascending); nothing: every pixel
  std::vector<std::size_t> only = {};  ///< the lights that are done (indices); empty: all of them
  /// The scene of the last run of this method, if nothing in it has changed: it is not prepared again.
  const visibility::SceneFloats* prepared = nullptr;
  /// Gets the scene that the method holds, as soon as it holds it: also of a run that does not come to its end.
  const visibility::SceneFloats** holds = nullptr;
  /// Rows that are evaluated at once: at most so many. Between them Progress may stop the run.
  std::uint32_t band_rows = std::numeric_limits<std::uint32_t>::max();
  std::string stage = {};  ///< what the bar of progress says; empty: the method's name
};

/// Of one light, medians where there were several runs.
struct LightTimes {
  double light = 0, evaluate = 0;
};

/// Times of one method over all lights, in seconds: medians where there were several runs.
struct RunTimes {
  double mesh = 0, light = 0, evaluate = 0;
  double view = 0;                 ///< of the first run: handing view samples to the method
  double read = 0;                 ///< of the first run: reading back, and sinks
  std::vector<LightTimes> lights;  ///< of each of the plan's; 0 for those that were not done
  std::optional<double> warmup;    ///< the discarded run's light + evaluate less the medians, >= 0; empty: no such run
  std::uint32_t runs = 0;          ///< timed runs
  double total = 0;                ///< wall-clock of all that was done for this method, reading back and sinks included
};

struct MethodRun {
  RunTimes times;
  std::vector<std::vector<float>> visibility;  ///< for each light that was done, V of each pixel; NaN: not evaluated
  std::vector<visibility::PassTime> passes;    ///< of the last run
  std::map<std::string, std::uint64_t> counters;
  std::uint64_t memory_bytes = 0;
  const visibility::SceneFloats* prepared = nullptr;  ///< what the method holds now (RunPlan::prepared)
};

/// Adds what another method made of other lights of the same plan, or of another part of the same ones.
void add_run(MethodRun& to, MethodRun&& other);

/// Runs a method on a session: mesh once, then light and tiles, and reads the first run's result. In one place for
/// every method stand the host's rules: background, pixels that carry the light's own body, and receivers with
/// receivesShadow = false are visible from every light sample, and those that the light does not light (a mesh's
/// `lights`) from none. Where a light has casters of its own, the method gets the scene in which nothing else casts.
/// Surfaces that let light through take their part of masks after the method (visibility::AlphaFilter), in the time of
/// `evaluate`.
MethodRun run_method(visibility::Method& method, const Session& session, const RunPlan& plan, const TileSink& sink,
                     Progress& progress);

}  // namespace penumbra::app
