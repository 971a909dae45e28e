// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/options.hpp"
#include "compare/metrics.hpp"
#include "render/machine.hpp"

#include <cstdint>
#include <functional>
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

/// Result of one contestant on one subject with one number of light samples.
struct Contestant {
  std::string name;    ///< a method with its options, or a peer such as "plain-rays"
  std::string device;  ///< device of the runs
  double mesh = 0;     ///< seconds, once
  Times times;
  std::optional<compare::VisibilityError> error;  ///< of V against rays on the same light samples, judged pixels
  std::optional<compare::VisibilityError> error_to_reference;
  std::optional<compare::PairCounts> pairs;       ///< against rays; only for methods with masks
  std::map<std::string, double> passes;           ///< milliseconds of each pass in the last run
  std::map<std::string, std::uint64_t> counters;  ///< of the last run
  std::optional<std::uint64_t> memory;            ///< bytes, peak on this subject so far; methods only
  int packet = 0;                  ///< rays traced together: the fastest of the sizes tried; ray casters only
  std::uint64_t view_samples = 0;  ///< number of view samples traced with all light samples; ray casters only
};

struct Entry {
  std::string subject;                                   ///< stable name
  std::string name;                                      ///< the subject's name, with "/n=N" where N was requested
  std::uint64_t triangles = 0, pixels = 0, samples = 0;  ///< pixels with A = 1; light samples
  std::uint32_t width = 0, height = 0;
  double load_before = 0;  ///< the machine's load, mean of the last minute; if above this process's own, the times are
                           ///< unreliable
  std::string reference;   ///< reference of error_to_reference and its number of pixels; empty: none
  std::uint64_t reference_pixels = 0;
  std::vector<Contestant> contestants;  ///< methods, peers, the oracle
};

/// Returns the contestant of this name, or nullptr.
const Contestant* find_contestant(const Entry& entry, const std::string& name);

/// Runs all contestants on one subject, once for each number of light samples, on the same view samples and (except for
/// jittered peers) light samples. The contestants alternate: one run of each, then the next run of each, so that other
/// load of the machine affects all of them equally. The first run of each is discarded. Contestants that fail are left
/// out, with a line on stderr.
void measure(const Subject& subject, const Options& options, const render::Machine& machine,
             const std::function<void(const Entry&)>& sink);

}  // namespace penumbra::bench
