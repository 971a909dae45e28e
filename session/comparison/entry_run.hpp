// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"
#include "compare/stats.hpp"
#include "render/machine.hpp"
#include "session/comparison/comparison.hpp"
#include "session/comparison/comparison_entries.hpp"
#include "session/comparison/comparison_files.hpp"
#include "session/pictures/picture_format.hpp"
#include "session/process/progress.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Results of one entry of a comparison.
struct EntryRun {
  MethodRun run;                   ///< of whole lights (whole_lights.hpp)
  std::vector<glm::vec3> beauty;   ///< of all lights, linear
  std::vector<std::string> masks;  ///< PackedMasks::finish()
  Image8 picture = {};             ///< the beauty in sRGB, once an exposure is known
};

/// Scene, machine and options that all runs of a comparison share. Every reference must outlive the runner.
struct EntrySurroundings {
  const Session& session;
  const render::Machine& machine;
  const ComparisonOptions& options;
  const ComparisonFiles& files;
  const PictureFormat& format;
  const std::optional<std::vector<std::uint32_t>>& wanted;  ///< pixels to be evaluated; nullopt: every pixel
  Progress& progress;
  std::function<void(std::string)> warn;
};

/// Runs entries of a comparison, each as often as it is timed, and writes their pictures.
class EntryRunner {
 public:
  explicit EntryRunner(EntrySurroundings surroundings) : with_(std::move(surroundings)) {}

  /// Runs a method and writes its EXR and, if requested, its bits.
  EntryRun run(const Entry& entry, bool is_reference, const std::vector<visibility::Light>& lights,
               const TileSink& sink) const;
  [[nodiscard]] compare::Stats stats_of(const Entry& entry, std::span<const visibility::Light> lights,
                                        const MethodRun& run) const;

 private:
  /// Writes the EXR of an entry.
  void write(const Entry& entry, std::span<const visibility::Light> lights, const EntryRun& done,
             const BeautyAccumulator& beauty) const;

  EntrySurroundings with_;
};

}  // namespace penumbra::session
