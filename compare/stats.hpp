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

/// Wall-clock seconds of one method; what was not measured stays empty and becomes null. `shadow` is light + evaluate.
struct Seconds {
  std::optional<double> load;      ///< reading the scene
  std::optional<double> mesh;      ///< once a mesh: adjacency, hierarchies, upload
  std::optional<double> view;      ///< view samples: shared by all methods
  std::optional<double> light;     ///< redone when a light moves
  std::optional<double> evaluate;  ///< from stored view samples to V or masks in the method's memory
  std::optional<double> beauty;    ///< reading back what a method found, and integrating it
  std::optional<double> write;     ///< files
  std::optional<double> warmup;    ///< first run less the median, at least 0
  std::optional<double> total;     ///< their sum; of a rendered picture, what the clock on the wall says

  [[nodiscard]] std::optional<double> shadow() const;
  /// All phases that are known.
  [[nodiscard]] double sum() const;
};

/// What one light was asked, and what that cost.
struct LightStats {
  std::string name;
  std::string method;
  visibility::MethodOptions options = {};
  bool area = false;                ///< V is the visible area, exactly or about: there are no light samples
  std::uint32_t light_samples = 0;  ///< 0 of areas
  std::string sample_pattern = {};  ///< empty of areas
  bool in_part = false;             ///< samples only where something may let light through, exact areas elsewhere
  std::optional<double> light = {}, evaluate = {};  ///< seconds
};

/// stats.json: what one run of one method was asked and what it cost.
struct Stats {
  std::string scene;
  std::uint32_t width = 0, height = 0;
  std::string device;
  std::uint64_t triangles = 0;
  std::string method;
  visibility::MethodOptions options;
  std::uint32_t light_samples = 0;  ///< 0: V is an area
  std::string sample_pattern;       ///< empty: likewise
  std::vector<LightStats> lights;   ///< what stands above is of the first
  std::uint32_t runs = 1;           ///< timed ones, whose medians are in `seconds`
  Seconds seconds;
  std::vector<visibility::PassTime> passes;
  std::uint64_t peak_memory_bytes = 0;          ///< the method's own structures
  std::map<std::string, std::uint64_t> memory;  ///< bytes of each structure of the run, and what all of it took
  std::map<std::string, std::uint64_t> counters;
  std::vector<std::string> warnings;
};

/// Why a method gave no result.
struct MethodFailure {
  int exit_code = 0;  ///< what the program would have ended with, had it been asked for this method alone
  std::string message;
};

/// A method with masks against rays (`raytrace`) on its own light samples, whatever the reference is: what a number of
/// light samples costs is not in it, only what the method itself does wrong.
struct SameSamples {
  std::optional<VisibilityError> error = {};  ///< over judged pixels
  PairCounts pairs = {};
  PairVerdicts verdicts = {};  ///< of all differing pairs, or of an evenly spaced sample of them
};

/// What a method makes of one light.
struct LightResult {
  std::string name;
  std::uint64_t judged_pixels = 0, horizon_pixels = 0;
  std::optional<VisibilityError> error, horizon_error;
  std::optional<SameSamples> same_samples;  ///< none for a method without masks
  std::optional<ErrorBudget> error_budget =
      {};                                ///< of an image-based method, if it was asked for and pixels are judged
  std::vector<ClassError> classes = {};  ///< the judged pixels by what happens there
  /// Pixels in the penumbra by how wide it is there, in pixels and in texels of the method's map (empty: it has none),
  /// and shadowed pixels by how far what hides the light is, in pixels. Empty: not known.
  std::vector<RangeError> by_width = {}, by_texels = {}, by_contact = {};
  std::optional<EyeError> eye = {};  ///< over judged pixels
};

/// Of a sequence: steps of V from one frame to the next that the reference does not make.
struct Pops {
  double share = 0;  ///< of judged pixels' steps: |ΔV − ΔV of the reference| > 0.05
  double max = 0;    ///< the largest
};

/// One line of metrics.json. What does not apply stays empty and becomes null.
struct MethodResult {
  std::string entry;  ///< the method as asked for: "pcss:search=16"
  Stats stats;
  std::vector<LightResult> lights;                  ///< each light of the scene, the chosen one first
  std::optional<VisibilityError> all_lights_error;  ///< over all lights' judged pixels together
  // Of the first light:
  std::optional<VisibilityError> error;          ///< over judged pixels
  std::optional<VisibilityError> horizon_error;  ///< over horizon pixels
  std::optional<BeautyError> beauty_error;       ///< over judged pixels, of all lights
  std::optional<Separation> separation = {};     ///< likewise, of scalar methods
  std::optional<Flip> flip = {};                 ///< of the beauty's picture
  std::optional<double> flicker = {};    ///< of a sequence: RMSE of ΔV − ΔV of the reference from frame to frame
  std::optional<Pops> pops = {};         ///< likewise
  std::optional<PairCounts> pairs;       ///< two sample-based methods on the same samples
  std::optional<PairVerdicts> verdicts;  ///< of all differing pairs, or of an evenly spaced sample of them
  std::optional<MethodFailure> failure;  ///< then there are no seconds, errors and pairs
};

/// Rays on the methods' own light samples, run beside a reference that looks at others.
struct SampleCost {
  Stats stats;
  std::vector<LightResult> lights;                  ///< against the reference: what so many light samples cost
  std::optional<VisibilityError> all_lights_error;  ///< over all lights' judged pixels together
};

/// metrics.json.
struct Metrics {
  Stats reference;
  std::uint64_t judged_pixels = 0, horizon_pixels = 0;  ///< of the first light
  std::optional<SampleCost> same_samples;
  std::vector<MethodResult> methods;
};

nlohmann::ordered_json to_json(const LightStats& light);
nlohmann::ordered_json to_json(const Stats& stats);
nlohmann::ordered_json to_json(const Metrics& metrics);

/// Indented, with a last newline. Bytes that are no UTF-8 (a file's name may hold any) become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace penumbra::compare
