#pragma once

#include "bench/options.hpp"
#include "compare/metrics.hpp"
#include "render/device.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Seconds of the timed runs, in order.
struct Times {
  std::vector<double> light, evaluate;

  [[nodiscard]] std::vector<double> shadow() const;  ///< light + evaluate, run by run
};

struct Timing {
  double median = 0, lowest = 0, highest = 0;
  [[nodiscard]] double spread() const { return median > 0 ? (highest - lowest) / median : 0; }
};
Timing timing_of(std::vector<double> seconds);

/// What one contestant did on one subject.
struct Contestant {
  std::string name;    ///< "view-sample", "plain-rays" (the speed peer), "raytrace"
  std::string device;  ///< where it ran
  double mesh = 0;     ///< once
  Times times;
  std::optional<compare::VisibilityError> error;  ///< of V against raytrace, over judged pixels
  std::optional<compare::PairCounts> pairs;       ///< against raytrace; only of methods with masks
  std::map<std::string, double> passes;           ///< milliseconds, of the last run
  std::map<std::string, std::uint64_t> counters;  ///< of the last run
};

struct Entry {
  std::string subject;
  std::uint64_t triangles = 0, pixels = 0, samples = 0;  ///< pixels with A = 1; light samples
  std::uint32_t width = 0, height = 0;
  int packet = 0;          ///< rays in the speed peer's packets: the fastest of those tried
  double load_before = 0;  ///< of the machine, mean of the last minute: above what this process itself makes, distrust
  std::vector<Contestant> contestants;  ///< view-sample, plain-rays, raytrace
};

/// Runs all contestants on the same view samples and light samples, interleaved: a run of each, then the next run of
/// each, so that whatever else the machine does meets them alike. The first run of each is discarded.
Entry measure(const Subject& subject, const Options& options, const render::Device& device);

}  // namespace penumbra::bench
