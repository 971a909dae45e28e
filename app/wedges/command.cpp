// SPDX-License-Identifier: Apache-2.0
// Command `wedges`: options and output.

#include "app/commands.hpp"
#include "app/reading_options.hpp"
#include "app/run_options.hpp"
#include "base/atomic_file.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/picture_size.hpp"
#include "session/options.hpp"
#include "session/process/output_files.hpp"
#include "session/wedges/built_wedges.hpp"
#include "volumes/wedges/wedge_export.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace penumbra::app {
namespace {

/// Returns the index of the element with this name; 0 for an empty name.
template <typename Named>
std::uint32_t find_named(const std::vector<Named>& all, const char* option, const std::string& name,
                         const scenes::Scene& scene) {
  if (name.empty()) return 0;
  const auto found = std::ranges::find(all, name, &Named::name);
  if (found != all.end()) return static_cast<std::uint32_t>(found - all.begin());
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  throw UsageError("{} {}: {} has no such name; it has: {}{}", option, name, scene.name, fmt::join(names, ", "),
                   did_you_mean(name, names));
}

/// Makes the camera and the size of `render` the scene's first, for the explained pixel.
void look_through(scenes::Scene& scene, const std::string& camera, const std::string& size) {
  std::swap(scene.cameras.front(), scene.cameras[find_named(scene.cameras, "--camera", camera, scene)]);
  std::tie(scene.width, scene.height) =
      size.empty() ? scenes::picture_size(scene, scene.cameras.front()) : session::parse_size(size);
}

class WedgesCommand : public Command {
 public:
  explicit WedgesCommand(CLI::App& app)
      : Command(app, "wedges", "build penumbra wedges of a light, prove them by exact signs, and export them") {
    cli_.add_option("SCENE", scene_, "scene file: .json (penumbra-scene/1), .gltf or .glb; or a mesh file")->required();
    cli_.add_option("--light", light_, "the light's name (default: the first)")->type_name("NAME");
    cli_.add_option("--construction", construction_,
                    "original (Assarsson and Akenine-Möller 2003), tight (the penumbra's own facets), or one that is "
                    "wrong on purpose, broken:1 to broken:6")
        ->type_name("NAME")
        ->capture_default_str();
    cli_.add_option("--from", from_,
                    "edges that are silhouettes from the light's centre, or from anywhere on it (tight is then cropped "
                    "by the planes of adjacent triangles)")
        ->type_name("centre|anywhere")
        ->capture_default_str();
    cli_.add_flag("--validate", validate_, "prove every invariant; exit with 1 if one does not hold");
    cli_.add_option("--export", export_, "wedges cut by the scene's box, edges, light, offending points")
        ->type_name("FILE.glb|.obj|.ply");
    cli_.add_option("--json", json_, "edges, planes, violations")->type_name("FILE");
    cli_.add_option("--explain", explain_,
                    "explain this pixel of the picture that `render` makes: the wedges that contain its surface point, "
                    "the area that each subtracts or adds, their sum, and the exact area")
        ->type_name("X,Y");
    cli_.add_option("--size", size_, "size of the picture of --explain (default: as in `render`)")->type_name("WxH");
    cli_.add_option("--camera", camera_,
                    "camera of the picture of --explain, as in `render` (default: the scene's first)")
        ->type_name("NAME|fit|E:T[:FOV]");
    cli_.add_option("--svg", svg_, "the light as seen from the pixel of --explain, with projected edges")
        ->type_name("FILE.svg")
        ->needs("--explain");
    add_allow_outside(cli_, allow_outside_);
    add_lenient(cli_, lenient_);
    add_studio_options(cli_, studio_);
  }

  int run(const GlobalOptions&) override {
    session::OutputFiles outputs = named_outputs();
    outputs.refuse_inputs({&scene_, 1});
    outputs.require_writable();
    scenes::Scene scene = scenes::read_scene(scene_, {.allow_outside = allow_outside_,
                                                      .lenient = lenient_,
                                                      .studio = session::parse_studio(studio_, camera_),
                                                      .bytes_per_copy = session::BuiltWedges::kBytesPerTriangle});
    outputs.refuse_inputs(scene.sources);
    for (const std::string& warning : scene.warnings) spdlog::warn("{}", warning);
    look_through(scene, camera_, size_);
    const session::BuiltWedges built(scene, {light_, construction_, from_, validate_});
    for (const std::string& warning : built.warnings) spdlog::warn("{}", warning);
    session::WedgesResult result = built.result();
    std::optional<session::Explanation> explanation;
    if (!explain_.empty()) {
      const auto [x, y] = session::parse_pixel(explain_, scene);
      explanation =
          session::explain({scene, built.floats, built.light, built.casters, built.casting, built.wedges}, x, y);
      result.explanation = &*explanation;
      if (!explanation->picture.empty()) result.svg = svg_;
    }
    if (!result.svg.empty()) write_file_atomically(result.svg, std::string_view(explanation->picture));
    if (!json_.empty()) write_file_atomically(json_, std::string_view(session::wedges_json(result)));
    if (!export_.empty()) {
      volumes::export_wedges(export_, {built.wedges, built.hull, volumes::bounds_of(built.casters), built.floats.origin,
                                       built.report ? std::span<const volumes::Violation>(built.report->violations)
                                                    : std::span<const volumes::Violation>()});
    }
    session::print_wedges(result);
    return static_cast<int>(built.holds() ? ExitCode::done : ExitCode::answer_is_no);
  }

 private:
  [[nodiscard]] session::OutputFiles named_outputs() const {
    constexpr std::array kExtensions = {".glb", ".obj", ".ply"};
    if (!export_.empty() && std::ranges::find(kExtensions, export_.extension()) == kExtensions.end()) {
      throw UsageError("--export {}: expected a name that ends in .glb, .obj or .ply", export_.string());
    }
    if (!svg_.empty() && svg_.extension() != ".svg") {
      throw UsageError("--svg {}: expected a name that ends in .svg", svg_.string());
    }
    session::OutputFiles outputs;
    outputs.add("--export", export_);
    outputs.add("--json", json_);
    outputs.add("--svg", svg_);
    return outputs;
  }

  std::filesystem::path scene_, export_, json_, svg_;
  std::string camera_, size_, light_, construction_ = "original", from_ = "centre", explain_;
  bool validate_ = false, allow_outside_ = false, lenient_ = false;
  session::StudioOptions studio_;
};

}  // namespace

std::unique_ptr<Command> make_wedges_command(CLI::App& app) {
  return std::make_unique<WedgesCommand>(app);
}

}  // namespace penumbra::app
