#pragma once

#include "base/image.hpp"
#include "compare/machine.hpp"
#include "compare/stats.hpp"
#include "scenes/scene.hpp"
#include "visibility/method.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

/// A line of a table of facts: "Camera", "at (4, 3, 5) …".
struct ReportFact {
  std::string name, value;
};

/// What the report shows of one method beside its numbers; pictures that were not made are left out.
struct ReportEntry {
  visibility::MethodDescription description;
  std::optional<Image8> beauty, visibility;
  std::optional<Image8> error;  ///< none for the reference
};

/// All that the report says. Every string may come from a user: the report escapes it.
struct ReportInput {
  std::string version;                 ///< of the program
  std::vector<std::string> arguments;  ///< what followed the program's name, for "how to reproduce"
  std::vector<ReportFact> scene;       ///< describe_scene() and what else there is to say
  Metrics metrics;                     ///< the same numbers as metrics.json
  ReportEntry reference;
  std::vector<ReportEntry> methods;  ///< in the order of metrics.methods
  std::string light;                 ///< the name of the light that V, errors and pairs are of
  double error_limit = 1;            ///< of the error pictures' scale
  float exposure = 1;                ///< of the beauty pictures
  bool same_samples = false;         ///< the reference used the methods' light samples
  std::uint64_t sampled_pixels = 0;  ///< 0: every pixel was compared
  Machine machine;
  std::vector<std::string> warnings;  ///< beside those in the stats
};

/// The scene in words: size, triangles, objects, each light, the camera.
std::vector<ReportFact> describe_scene(const scenes::Scene& scene, std::size_t camera);

/// One self-contained HTML page: no scripts, nothing from the network, pictures inside. Readable by someone who has
/// never seen the program, in light and dark, on a phone and on paper.
std::string report_html(const ReportInput& input);

/// Writes it whole or not at all.
void write_report(const std::filesystem::path& path, const ReportInput& input);

}  // namespace penumbra::compare
