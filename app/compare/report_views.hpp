// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/runner.hpp"
#include "app/session.hpp"
#include "base/packed.hpp"
#include "compare/report.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Masks of a run for the report, deflated tile by tile.
class PackedMasks {
 public:
  explicit PackedMasks(std::size_t lights) : lights_(lights) {}
  void add(const TileResult& tile);
  /// Returns base64 of each light's masks; empty for a light without masks, or with too many.
  std::vector<std::string> finish();

  /// Limit for one light, in a browser's memory. A picture of 512 × 512 pixels with 1024 light samples has 32 MiB.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  /// Limit for one light, in the page.
  static constexpr std::size_t kMostPackedBytes = std::size_t{3} << 20;

 private:
  struct One {
    std::optional<Deflated> deflated;
    std::size_t bytes = 0;
  };
  std::vector<One> lights_;
};

/// Returns each whole light's data for the report's read-out. `reference`: the lights with the reference's samples.
std::vector<compare::ReportLight> report_lights(const Session& session, std::span<const visibility::Light> reference,
                                                bool same_samples);

/// Numbers of a run of whole lights.
struct SeenByRun {
  const MethodRun& run;
  std::span<const glm::vec3> beauty;                 ///< empty: none is shown
  std::vector<std::string> masks;                    ///< PackedMasks::finish(), of each of the session's lights
  std::span<const glm::vec3> reference_beauty = {};  ///< base of packing the beauty; empty: the reference's
};
compare::ReportEntry report_entry(const Session& session, const visibility::MethodDescription& description,
                                  SeenByRun seen);

}  // namespace penumbra::app
