// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/options.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace penumbra::bench {

/// Duration of a sequence of pictures, and the sums of its frames' own times.
struct SequenceEntry {
  std::string name;  ///< stable: "sequence/knot-70000/size=1080/frames=100"
  std::uint64_t triangles = 0;
  std::uint32_t width = 0, height = 0, frames = 0;
  double load_before = 0;
  double elapsed = 0;                    ///< of the program, from start to end
  std::map<std::string, double> phases;  ///< seconds of stats.json, sums over all frames

  /// Returns view + light + evaluate + beauty + write.
  [[nodiscard]] double work() const;
};

/// Times --sequence: `penumbra render` of a glTF file whose first light and camera move in every frame, with exact
/// areas, by the program in the folder of this one. Pictures are removed once complete. Throws ResourceError if the
/// program fails.
void measure_sequences(const Options& options, const std::function<void(const SequenceEntry&)>& sink);

std::string sequence_table_head();
std::string sequence_table_row(const SequenceEntry& entry);
std::string sequence_json_line(const SequenceEntry& entry, const Options& options);

}  // namespace penumbra::bench
