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

/// A line of a table of facts: "Camera", "at (4, 3, 5) …".
struct ReportFact {
  std::string name, value;
};

/// Where a repair of a method's error changes V, and by how much: LightResult::error_budget has the numbers.
struct BudgetPicture {
  std::string repaired;  ///< "resolution", "layers" …, kAllButView or kAllAtOnce
  Image8 picture;
};

inline constexpr const char *kAllButView = "all but the view", *kAllAtOnce = "all at once";

/// What the report shows of one method under one light. The pictures are for eyes without script; what the page's
/// script draws and reads out is packed (compare/report_data.hpp), empty if it was not kept.
struct ReportLightView {
  std::optional<Image8> visibility = {};
  std::optional<Image8> error = {};  ///< none for the reference
  std::string packed_visibility = {};
  std::string packed_masks = {};
  std::vector<BudgetPicture> budget_pictures = {};
};

/// What the report shows of one method beside its numbers; what was not made is left out.
struct ReportEntry {
  visibility::MethodDescription description;
  std::optional<Image8> beauty;
  std::string packed_beauty;
  std::vector<ReportLightView> lights;  ///< as ReportInput::lights
};

/// A light as the report tells of it, with what its read-out needs.
struct ReportLight {
  std::string name;
  std::string packed_classes = {};                 ///< visibility::PixelClass of each pixel
  bool round = false;                              ///< a disk or sphere; else a rectangle, or what one bounds
  double aspect = 1;                               ///< length of u over that of v
  std::vector<glm::dvec2> samples = {};            ///< of the methods, along u and v in [−1, 1]
  std::vector<glm::dvec2> reference_samples = {};  ///< empty: the same
};

/// All that the report says. Every string may come from a user: the report escapes it.
struct ReportInput {
  std::string version;                 ///< of the program
  std::vector<std::string> arguments;  ///< what followed the program's name, for "how to reproduce"
  std::vector<ReportFact> scene;       ///< describe_scene() and what else there is to say
  Metrics metrics;                     ///< the same numbers as metrics.json
  std::vector<ReportLight> lights;     ///< the chosen one first; at least one
  ReportEntry reference;
  std::optional<ReportEntry> rays;   ///< on the methods' light samples, where the reference looked at others
  std::vector<ReportEntry> methods;  ///< in the order of metrics.methods
  double error_limit = 1;            ///< of the error pictures' scale
  float exposure = 1;                ///< of the beauty pictures
  bool same_samples = false;         ///< the reference used the methods' light samples
  std::uint64_t sampled_pixels = 0;  ///< 0: every pixel was compared
  Machine machine;
  std::vector<std::string> warnings;  ///< beside those in the stats
};

/// The scene in words: triangles, objects, each light, the camera.
std::vector<ReportFact> describe_scene(const scenes::Scene& scene, std::size_t camera);

/// One self-contained HTML page: nothing from the network, pictures inside. Readable by someone who has never seen the
/// program, in light and dark, on a phone and on paper, and without script. Script of its own (compare/page/) adds a
/// viewer, a read-out of each pixel, and tables that sort.
std::string report_html(const ReportInput& input);

/// Writes it whole or not at all.
void write_report(const std::filesystem::path& path, const ReportInput& input);

}  // namespace penumbra::compare
