// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/sweep/ranges.hpp"
#include "scenes/scene.hpp"
#include "session/comparison/comparison.hpp"
#include "session/options.hpp"
#include "session/process/progress.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// Method with one combination of values, under one size of the lights.
struct SweepRow {
  std::map<std::string, std::string> light;  ///< light.half, light.angle: swept values; empty: the scene's
  compare::MethodResult result;
  bool on_hull = false;  ///< under this light no other row has both less error and less time
};

/// Least seconds that a method needs for shadows with an error of V of at most `rmse`.
struct SecondsTo {
  double rmse = 0;
  std::optional<double> seconds = {};  ///< nullopt: no row of the method has so small an error
  std::string entry = {};
};

/// Best rows of a method under one size of the lights.
struct SweepSummary {
  std::map<std::string, std::string> light;
  std::string method;
  std::vector<SecondsTo> to;  ///< for 1/64, 1/128 and 1/256
};

struct Sweep {
  std::vector<SweptKey> over;
  compare::Stats reference;  ///< of the first comparison
  std::vector<SweepRow> rows;
  std::vector<SweepSummary> summaries;
};

/// Compares each of the methods at each value of the keys that are its options (all products), under each size of the
/// lights (light.half: the larger half of a light's extent in the scene's unit; light.angle: a sun's diameter in
/// degrees), and for each number of light-samples if the method uses light samples. Throws UsageError for a key without
/// effect, and the same errors as compare_methods().
Sweep sweep_methods(const scenes::Scene& scene, const session::RunOptions& run, session::ComparisonOptions options,
                    std::vector<SweptKey> over, session::Progress& progress);

}  // namespace penumbra::app
