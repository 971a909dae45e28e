#pragma once

#include "app/options.hpp"
#include "app/process/progress.hpp"
#include "compare/stats.hpp"
#include "scenes/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

class TevPictures;

/// What `compare` was asked beside RunOptions.
struct ComparisonOptions {
  std::vector<MethodEntry> methods;
  visibility::MethodOptions method_options;  ///< for every method that has such an option
  std::string reference = "raytrace";
  std::string reference_samples = "1024";  ///< or "same"
  std::string sample_pixels = "all";
  std::uint32_t runs = 0;  ///< timed runs of each entry; 0: as many as begin within two seconds, at most five
  bool bits = false, png = false;
  bool error_budget = false;      ///< why each image-based method is wrong
  std::filesystem::path stats;    ///< empty: only DIR/metrics.json
  TevPictures* tev = nullptr;     ///< shows each picture that is written
  bool writes = true;             ///< all of DIR; else nothing is written, and what is returned is all
  std::optional<double> time;     ///< when the scene is looked at, in seconds; nothing: at rest
  std::optional<float> exposure;  ///< of pictures for eyes, in stops; nothing: the reference's fill them
};

/// e = V − V of the reference at each pixel under the first light, for each entry; NaN where it is not judged. Empty:
/// the entry failed.
using EntryErrors = std::vector<std::vector<float>>;

/// Runs the reference, then each method on the same view samples, and writes all of DIR. Every light is judged; what is
/// said once is of the first. Seconds are sums over all lights. `arguments` is the command line, for the report.
/// `errors`: gets each entry's; null: nobody wants them.
compare::Metrics compare_methods(const RunOptions& run, const ComparisonOptions& options,
                                 const std::vector<std::string>& arguments, Progress& progress,
                                 EntryErrors* errors = nullptr);
/// Compares on a scene that has been read already.
compare::Metrics compare_methods(scenes::Scene scene, const RunOptions& run, const ComparisonOptions& options,
                                 Progress& progress);

}  // namespace penumbra::app
