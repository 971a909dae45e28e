// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <algorithm>
#include <list>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::scenes {

/// Scenes of one animated file that are read before they are needed: the file is opened and parsed once for several
/// times of its animation. One reader at a time.
struct ScenesAhead {
  struct Read {
    double time;
    Scene scene;
    Instances instances;
  };

  std::vector<double> times;  ///< times needed later, in this order, in seconds; without those in `kept`
  std::list<Read> kept;       ///< read, and not yet taken
  std::optional<Scene> rest;  ///< the file at rest, around which studios are built

  /// Returns the scene at `time`, if it was read ahead, and forgets it.
  std::optional<Read> take(double time) {
    const auto found = std::ranges::find(kept, time, &Read::time);
    if (found == kept.end()) return std::nullopt;
    std::optional<Read> read(std::move(*found));
    kept.erase(found);
    return read;
  }
};

}  // namespace penumbra::scenes
