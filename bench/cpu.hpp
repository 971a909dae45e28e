// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/options.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Result of one part on one mesh.
struct CpuEntry {
  std::string name;  ///< stable: "cpu/edge-graph/triangles=5000", "cpu/wedges/tight/edges=1000000"
  std::uint64_t triangles = 0, edges = 0;
  std::uint64_t items = 0;           ///< number of items made: edges, records, wedges
  std::vector<double> seconds;       ///< of the timed runs, in order
  std::optional<double> growth;      ///< median ÷ median of the previous mesh
  std::optional<double> host_ratio;  ///< of a device only: median of its twin on the processor ÷ its own median
  std::string device;                ///< empty: the processor
  std::map<std::string, std::uint64_t> counts;
  std::map<std::string, double> passes;  ///< of a device: milliseconds of each pass, run by run
  double load_before = 0;
};

/// Times the parts that run on the processor once for each mesh, on knots of growing size: edge graph, edge records
/// with their casters, hierarchy over the records; and penumbra wedges of `edges` edges of a knot, by either
/// construction.
void measure_cpu(const Options& options, const std::function<void(const CpuEntry&)>& sink);

/// Returns the machine's load, mean of the last minute; NaN if unknown.
double load_of_machine();

}  // namespace penumbra::bench
