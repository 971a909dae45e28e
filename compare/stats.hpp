// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/error_budget.hpp"
#include "compare/eye.hpp"
#include "compare/metrics.hpp"
#include "visibility/method.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

/// Wall-clock seconds of one method; values that were not measured are empty and become null. `shadow` is light +
/// evaluate.
struct Seconds {
  std::optional<double> load;      ///< reading the scene
  std::optional<double> mesh;      ///< once for each mesh: adjacency, hierarchies, upload
  std::optional<double> view;      ///< view samples: shared by all methods
  std::optional<double> light;     ///< redone when a light moves
  std::optional<double> evaluate;  ///< from stored view samples to V or masks in the method's memory
  std::optional<double> beauty;    ///< reading back the method's result, and integrating it
  std::optional<double> write;     ///< files
  std::optional<double> warmup;    ///< first run less the median, at least 0
  std::optional<double> total;     ///< sum of the phases; of a rendered picture, wall-clock time

  [[nodiscard]] std::optional<double> shadow() const;
  /// Returns the sum of all known phases.
  [[nodiscard]] double sum() const;
};

/// Request and cost of one light.
struct LightStats {
  std::string name;
  std::string method;
  visibility::MethodOptions options = {};
  bool area = false;                ///< V is the visible area, exact or estimated: there are no light samples
  std::uint32_t light_samples = 0;  ///< 0 for areas
  std::string sample_pattern = {};  ///< empty for areas
  bool in_part = false;             ///< samples only where some light may be visible, exact areas elsewhere
  std::optional<double> light = {}, evaluate = {};  ///< seconds
};

/// Lights left out of view samples where they are faint.
struct LightCutoff {
  double below = 0;          ///< requested largest share of a view sample's unshadowed light
  std::uint64_t pairs = 0;   ///< pairs of a view sample and a light that is left out there
  double largest_share = 0;  ///< largest left-out share of any view sample's light, all lights together
};

/// stats.json: request and cost of one run of one method.
struct Stats {
  std::string scene;
  std::uint32_t width = 0, height = 0;
  std::string device;
  std::uint64_t triangles = 0;
  std::string method;
  visibility::MethodOptions options;
  std::uint32_t light_samples = 0;  ///< 0: V is an area
  std::string sample_pattern;       ///< empty: V is an area
  std::vector<LightStats> lights;   ///< the values above are those of the first light
  std::uint32_t runs = 1;           ///< number of timed runs, whose medians are in `seconds`
  Seconds seconds;
  std::vector<visibility::PassTime> passes;
  std::uint64_t peak_memory_bytes = 0;          ///< the method's own structures
  std::map<std::string, std::uint64_t> memory;  ///< bytes of each structure of the run, and their total
  std::map<std::string, std::uint64_t> counters;
  std::vector<std::string> warnings;
  std::optional<LightCutoff> light_cutoff = {};  ///< empty: no light may be left out
};

/// Reason why a method has no result.
struct MethodFailure {
  int exit_code = 0;  ///< exit code of the program for this method alone
  std::string message;
};

/// Comparison of a method with masks against rays (`raytrace`) on its own light samples, whatever the reference is:
/// includes only errors of the method itself, not the effect of the number of light samples.
struct SameSamples {
  std::optional<VisibilityError> error = {};  ///< over judged pixels
  PairCounts pairs = {};
  PairVerdicts verdicts = {};  ///< of all differing pairs, or of an evenly spaced sample of them
};

/// Result of a method under one light.
struct LightResult {
  std::string name;
  std::uint64_t judged_pixels = 0, horizon_pixels = 0;
  std::optional<VisibilityError> error, horizon_error;
  std::optional<SameSamples> same_samples;       ///< empty for a method without masks
  std::optional<ErrorBudget> error_budget = {};  ///< if requested, and if pixels are judged
  std::vector<ClassError> classes = {};          ///< judged pixels by class
  /// Errors of pixels in the penumbra by its width, in pixels and in texels of the method's map (empty: there is no
  /// map), and of shadowed pixels by the distance of the hiding object, in pixels. Empty: unknown.
  std::vector<RangeError> by_width = {}, by_texels = {}, by_contact = {};
  std::optional<EyeError> eye = {};  ///< over judged pixels
};

/// Steps of V from one frame of a sequence to the next that the reference does not have.
struct Pops {
  double share = 0;  ///< fraction of judged pixels' steps with |ΔV − ΔV of the reference| > 0.05
  double max = 0;    ///< largest |ΔV − ΔV of the reference|
};

/// Line of metrics.json. Values that do not apply are empty and become null.
struct MethodResult {
  std::string entry;  ///< method as requested: "pcss:search=16"
  Stats stats;
  std::vector<LightResult> lights;                  ///< each light of the scene, the chosen one first
  std::optional<VisibilityError> all_lights_error;  ///< over all lights' judged pixels together
  // Results of the first light:
  std::optional<VisibilityError> error;          ///< over judged pixels
  std::optional<VisibilityError> horizon_error;  ///< over horizon pixels
  std::optional<BeautyError> beauty_error;       ///< over judged pixels, with all lights
  std::optional<Separation> separation = {};     ///< over judged pixels, for methods that know only V
  std::optional<Flip> flip = {};                 ///< of the beauty's picture
  std::optional<double> flicker = {};    ///< of a sequence: RMSE of ΔV − ΔV of the reference from frame to frame
  std::optional<Pops> pops = {};         ///< of a sequence
  std::optional<PairCounts> pairs;       ///< if method and reference have the same light samples
  std::optional<PairVerdicts> verdicts;  ///< of all differing pairs, or of an evenly spaced sample of them
  std::optional<MethodFailure> failure;  ///< if set, there are no seconds, errors and pairs
};

/// Rays on the methods' own light samples, run in addition to a reference with other samples.
struct SampleCost {
  Stats stats;
  std::vector<LightResult> lights;                  ///< errors that come from the number of light samples
  std::optional<VisibilityError> all_lights_error;  ///< over all lights' judged pixels together
};

/// Method of a group that was not compared, since it would have taken longer than its limit.
struct LeftOut {
  std::string entry;
  double seconds = 0, limit = 0;  ///< estimated time of a run; limit
};

/// Contents of metrics.json.
struct Metrics {
  Stats reference;
  std::uint64_t judged_pixels = 0, horizon_pixels = 0;  ///< of the first light
  std::optional<SampleCost> same_samples;
  std::vector<MethodResult> methods;
  std::vector<LeftOut> left_out;
};

nlohmann::ordered_json to_json(const LightStats& light);
nlohmann::ordered_json to_json(const Stats& stats);
nlohmann::ordered_json to_json(const Metrics& metrics);

/// Returns the JSON text, indented, with a final newline. Bytes that are not UTF-8 (a file's name may contain any)
/// become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace penumbra::compare
