// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/packed.hpp"
#include "compare/report.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Masks of a run for the report, deflated tile by tile.
class PackedMasks {
 public:
  explicit PackedMasks(std::size_t lights) : lights_(lights) {}
  void add(const TileResult& tile);
  /// Returns base64 of each light's masks; empty for a light without masks, or with too many.
  std::vector<std::string> finish();

  /// Largest size of one light's masks in a browser's memory, in bytes. A picture of 512 × 512 pixels with 1024 light
  /// samples has 32 MiB.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  /// Largest size of one light's deflated masks in the page, in bytes.
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

/// Results of a method's run, light by light, for the report.
struct SeenByRun {
  const MethodRun& run;
  std::span<const glm::vec3> beauty;                 ///< empty: none is shown
  std::vector<std::string> masks;                    ///< PackedMasks::finish(), of each of the session's lights
  std::span<const glm::vec3> reference_beauty = {};  ///< base of packing the beauty; empty: the reference's
};
compare::ReportEntry report_entry(const Session& session, const visibility::MethodDescription& description,
                                  SeenByRun seen);

}  // namespace penumbra::session
