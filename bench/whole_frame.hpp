// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/options.hpp"
#include "session/machine.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Whole frames of one contestant: seconds of each phase, run by run.
struct FrameTimes {
  using Phases = std::map<std::string, std::vector<double>>;

  std::string name;
  /// `floats` (double to float, planes), `mesh`, `view`, `light`, `evaluate`, `beauty`, `write`; rays have no `floats`
  /// and no phase after `evaluate`.
  Phases phases;
  /// Phases of the next frame, in which the light has moved.
  Phases next_phases;

  /// Return the seconds from a scene in memory to V of each pixel.
  [[nodiscard]] std::vector<double> frame() const { return until_evaluate(phases); }
  [[nodiscard]] std::vector<double> next() const { return until_evaluate(next_phases); }

  /// Returns the sums of the named phases, run by run; absent phases are skipped.
  [[nodiscard]] static std::vector<double> sum_of(const Phases& phases, const std::vector<std::string>& names);

 private:
  [[nodiscard]] static std::vector<double> until_evaluate(const Phases& phases) {
    return sum_of(phases, {"floats", "mesh", "view", "light", "evaluate"});
  }
};

struct FrameEntry {
  std::string subject, name;  ///< stable: "frame/sphere-1000000/size=512/n=256"
  std::uint64_t triangles = 0, samples = 0;
  std::uint32_t size = 0;
  double load_before = 0;
  std::vector<FrameTimes> contestants;  ///< the first: plain rays, the basis of comparison
};

/// Times whole pictures, each from a scene in memory, as made by `penumbra render`, in comparison with a plain program
/// on Embree: hierarchy of medium quality, primary rays, 64 shadow rays at every view sample, then all N where the
/// results of these differ. Each picture is followed by one in which the light has moved. The contestants alternate;
/// the first run of each is discarded.
void measure_whole_frames(const Options& options, const render::Machine& machine,
                          const std::function<void(const FrameEntry&)>& sink);

std::string frame_table_head();
std::string frame_table_rows(const FrameEntry& entry);
/// Returns one line for each contestant.
std::string frame_json_lines(const FrameEntry& entry, const Options& options);

}  // namespace penumbra::bench
