// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"
#include "compare/machine.hpp"
#include "compare/stats.hpp"
#include "scenes/scene.hpp"
#include "visibility/method.hpp"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

/// Line of a table of facts: "Camera", "at (4, 3, 5) …".
struct ReportFact {
  std::string name, value;
};

/// Picture of the change of V by a repair of a method's error: LightResult::error_budget has the numbers.
struct BudgetPicture {
  std::string repaired;  ///< "resolution", "layers" …, kAllButView or kAllAtOnce
  Image8 picture;
};

inline constexpr const char *kAllButView = "all but the view", *kAllAtOnce = "all at once";

/// Part of the report about one method under one light. Numbers are packed (compare/report_data.hpp), empty if not
/// kept.
struct ReportLightView {
  std::string packed_visibility = {};
  std::string packed_masks = {};
  std::vector<BudgetPicture> budget_pictures = {};
};

/// Part of the report about one method in addition to its numbers; parts that were not computed are left out.
struct ReportEntry {
  visibility::MethodDescription description;
  std::string packed_beauty;
  std::vector<ReportLightView> lights;  ///< in the order of ReportInput::lights
};

/// Light as described by the report, with the data of its read-out.
struct ReportLight {
  std::string name;
  std::string packed_classes = {};                 ///< visibility::PixelClass of each pixel
  bool round = false;                              ///< a disk or sphere; else a rectangle, or a shape bounded by one
  double aspect = 1;                               ///< length of u over that of v
  std::vector<glm::dvec2> samples = {};            ///< of the methods, along u and v in [−1, 1]
  std::vector<glm::dvec2> reference_samples = {};  ///< empty: the same
};

/// Contents of the report. Every string may come from a user: the report escapes it.
struct ReportInput {
  std::string version;                           ///< of the program
  std::vector<std::string> arguments;            ///< arguments of the program, for "how to reproduce"
  std::vector<std::string> view_arguments = {};  ///< arguments that show the scene in the live view; empty: unknown
  std::vector<ReportFact> scene;                 ///< describe_scene() and further facts
  Metrics metrics;                               ///< the same numbers as metrics.json
  std::vector<ReportLight> lights;               ///< the chosen one first; at least one
  ReportEntry reference;
  std::optional<ReportEntry> rays;   ///< rays on the methods' light samples, if the reference used others
  std::vector<ReportEntry> methods;  ///< in the order of metrics.methods
  double error_limit = 1;            ///< of the error pictures' scale
  float exposure = 1;                ///< of the beauty pictures
  bool same_samples = false;         ///< the reference used the methods' light samples
  std::uint64_t sampled_pixels = 0;  ///< 0: every pixel was compared
  Machine machine;
  std::vector<std::string> warnings;  ///< in addition to those in the stats
};

/// Returns the scene in words: triangles, objects, each light, the camera.
std::vector<ReportFact> describe_scene(const scenes::Scene& scene, std::size_t camera);

/// Returns one self-contained HTML page: no network access. Understandable without knowledge of the program, in light
/// and dark mode, on a phone and on paper. The page's script (compare/page/) draws tables, plots and pictures from the
/// page's JSON, which has everything in metrics.json; without script the page says where the numbers are.
std::string report_html(const ReportInput& input);

/// Writes the report's file, whole or not at all.
void write_report(const std::filesystem::path& path, const ReportInput& input);

}  // namespace penumbra::compare
