// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/stats.hpp"
#include "scenes/scene.hpp"
#include "session/options.hpp"
#include "session/process/progress.hpp"
#include "visibility/frame_memory.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::session {

class TevPictures;

/// Options of `compare` in addition to RunOptions.
struct ComparisonOptions {
  std::vector<MethodEntry> methods;
  visibility::MethodOptions method_options;  ///< for every method with such an option
  std::string reference = "raytrace";
  std::string reference_samples = "1024";  ///< a number, or "same"
  std::string sample_pixels = "all";
  std::uint32_t runs = 0;  ///< timed runs of each entry; 0: as many as fit into two seconds, one to five
  bool bits = false, png = false;
  bool error_budget = false;    ///< compute the causes of error of each method
  std::filesystem::path stats;  ///< empty: only DIR/metrics.json
  TevPictures* tev = nullptr;   ///< shows each written picture
  /// References evaluate only few pixels between two calls of Progress, for a caller that stops a comparison through
  /// it.
  bool reports_often = false;
  bool writes = true;          ///< writes all of DIR; false: writes nothing and only returns the result
  std::optional<double> time;  ///< time of the scene in seconds; nullopt: at rest
  /// Pictures of earlier frames, by entry; null: not a sequence.
  std::map<std::string, visibility::FrameMemory>* memories = nullptr;
  /// A method of a group (not requested by name) whose first run takes longer is left out, with a warning.
  double most_seconds = std::numeric_limits<double>::infinity();
  std::optional<float> exposure;  ///< of displayed pictures, in stops; nullopt: from the reference's brightness
  std::vector<std::string> view_arguments = {};  ///< arguments of the program that open the live view; for the report
};

/// e = V − V of the reference at each pixel under the first light, for each entry; NaN for pixels that are not judged.
/// Empty: the entry failed.
using EntryErrors = std::vector<std::vector<float>>;

/// Returns the memory that a comparison needs for each triangle of a copy, in addition to the scene itself: the scene
/// floats, and the largest need among the reference and the methods requested by name. Methods of a group that do not
/// fit are left out later.
std::uint64_t bytes_per_copy(const ComparisonOptions& options);

/// Runs the reference, then each method on the same view samples, and writes all of DIR. Every light is judged; numbers
/// given once are those of the first light. Seconds are sums over all lights. `arguments` is the command line, for the
/// report. `errors`: receives each entry's errors; may be null.
compare::Metrics compare_methods(const RunOptions& run, const ComparisonOptions& options,
                                 const std::vector<std::string>& arguments, Progress& progress,
                                 EntryErrors* errors = nullptr);
/// Compares on a scene that is already in memory.
compare::Metrics compare_methods(scenes::Scene scene, const RunOptions& run, const ComparisonOptions& options,
                                 Progress& progress);

}  // namespace penumbra::session
