#pragma once

#include "bench/options.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// What one part did on one mesh.
struct CpuEntry {
  std::string name;  ///< stable: "cpu/edge-graph/triangles=5000", "cpu/wedges/tight/edges=1000000"
  std::uint64_t triangles = 0, edges = 0;
  std::uint64_t items = 0;           ///< how many were made: edges, records, wedges
  std::vector<double> seconds;       ///< of the timed runs, in order
  std::optional<double> growth;      ///< median ÷ that of the mesh before
  std::optional<double> host_ratio;  ///< only of a device: the median of its twin on the processor ÷ its own
  std::string device;                ///< empty: the processor
  std::map<std::string, std::uint64_t> counts;
  std::map<std::string, double> passes;  ///< of a device: milliseconds of each, as `seconds`
  double load_before = 0;
};

/// The parts that run on the processor once a mesh, on knots of growing size: edge graph, edge records with their
/// casters, hierarchy over the records; and penumbra wedges of `edges` edges of a knot, by either construction.
void measure_cpu(const Options& options, const std::function<void(const CpuEntry&)>& sink);

/// The machine's load, mean of the last minute; NaN where it is not known.
double load_of_machine();

}  // namespace penumbra::bench
