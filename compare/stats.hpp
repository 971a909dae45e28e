#pragma once

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
  std::optional<double> warmup;    ///< first run less the median, at least 0
  std::optional<double> total;     ///< of the command up to here

  [[nodiscard]] std::optional<double> shadow() const;
};

/// stats.json: what one run of one method was asked and what it cost.
struct Stats {
  std::string scene;
  std::uint32_t width = 0, height = 0;
  std::string device;
  std::uint64_t triangles = 0;
  std::string method;
  visibility::MethodOptions options;
  std::uint32_t light_samples = 0;
  std::string sample_pattern;
  Seconds seconds;
  std::vector<visibility::PassTime> passes;
  std::uint64_t peak_memory_bytes = 0;
  std::map<std::string, std::uint64_t> counters;
  std::vector<std::string> warnings;
};

/// Why a method gave no result.
struct MethodFailure {
  int exit_code = 0;  ///< what the program would have ended with, had it been asked for this method alone
  std::string message;
};

/// One line of metrics.json. What does not apply stays empty and becomes null.
struct MethodResult {
  std::string entry;  ///< the method as asked for: "pcss:search=16"
  Stats stats;
  std::optional<VisibilityError> error;          ///< over judged pixels
  std::optional<VisibilityError> horizon_error;  ///< over horizon pixels
  std::optional<BeautyError> beauty_error;       ///< over judged pixels, of all lights
  std::optional<PairCounts> pairs;               ///< two sample-based methods on the same samples
  std::optional<PairVerdicts> verdicts;          ///< of all differing pairs, or of an evenly spaced sample of them
  std::optional<MethodFailure> failure;          ///< then there are no seconds, errors and pairs
};

/// metrics.json.
struct Metrics {
  Stats reference;
  std::uint64_t judged_pixels = 0, horizon_pixels = 0;
  std::vector<MethodResult> methods;
};

nlohmann::ordered_json to_json(const Stats& stats);
nlohmann::ordered_json to_json(const Metrics& metrics);

/// Indented, with a last newline. Bytes that are no UTF-8 (a file's name may hold any) become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace penumbra::compare
