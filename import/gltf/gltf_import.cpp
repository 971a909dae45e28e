// SPDX-License-Identifier: Apache-2.0
// Imports a glTF file as a scene or as a mesh, at one time or several: parses it once, then for each time poses its
// nodes and builds the scene.

#include "import/gltf/gltf_import.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_animation.hpp"
#include "import/gltf/gltf_clips.hpp"
#include "import/gltf/gltf_hidden.hpp"
#include "import/gltf/gltf_load.hpp"
#include "import/gltf/gltf_scene.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// Returns whether skins or morph targets move vertices apart from their nodes.
bool bends(const tinygltf::Model& model) {
  const auto morphs = [](const tinygltf::Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives, [](const auto& primitive) { return !primitive.targets.empty(); });
  };
  return !model.skins.empty() || std::ranges::any_of(model.meshes, morphs);
}

/// Returns the time span of the played animations. A scene at rest does not show them, so that damaged animations then
/// only cause a warning.
std::optional<scenes::Motion> motion_for(const tinygltf::Model& model, const ClipChoice& clips,
                                         const scenes::ReadOptions& options, std::vector<std::string>& warnings) {
  if (options.time && !clips.others.empty()) {
    warnings.push_back(
        fmt::format("the clips {} are not played, because they move the same properties as {} (choose with --clip)",
                    names_of_clips(model, clips.others), names_of_clips(model, clips.played)));
  }
  try {
    return motion_of(model, clips.played);
  } catch (const InputError& error) {
    if (options.time) throw;
    warnings.push_back(fmt::format("the animation is damaged and ignored: {}", error.what()));
    return std::nullopt;
  }
}

/// A parsed file, of which scenes at several times are built. `model`, `taken_out` and `options` must outlive it.
class ParsedFile {
 public:
  ParsedFile(Purpose purpose, std::string name, tinygltf::Model& model, const TakenOut& taken_out,
             const scenes::ReadOptions& options)
      : purpose_(purpose),
        name_(std::move(name)),
        model_(model),
        taken_out_(taken_out),
        options_(options),
        scales_(rest_scales(model)) {
    clips_ = choose_clips(model_, options.clips);
    motion_ = motion_for(model_, clips_, options, warnings_);
    if (bends(model_) || (motion_ && options.time)) origin_ = middle_at_rest(model_, {name_, options});
    if (!model_.animations.empty() && (purpose == Purpose::any_scene || purpose == Purpose::mesh))
      warnings_.push_back("the file is read at rest; its animation clips are " +
                          names_of_clips(model_, all_clips(model_)));
  }

  [[nodiscard]] bool moves() const { return motion_.has_value(); }

  /// Returns the scene at a time, or at rest. Must not be called for rest after a call with a time.
  scenes::Scene scene_at(std::optional<double> time) {
    if (time) pose_model(model_, *time, clips_.played);  // sets all animated nodes, wherever they were before
    const std::vector<std::size_t> played = time ? clips_.played : std::vector<std::size_t>();
    std::vector<std::optional<glm::dmat4>> unhidden;
    if (motion_) unhidden = unhidden_places(model_, scales_);
    auto [scene, left_vertices_out] = build_scene(model_, {name_, options_, unhidden, played}, purpose_, taken_out_);
    if (!origin_ && left_vertices_out && purpose_ != Purpose::mesh) origin_ = middle_at_rest(model_, {name_, options_});
    scene.origin = origin_;
    scene.motion = motion_;
    scene.warnings.insert(scene.warnings.begin(), warnings_.begin(), warnings_.end());
    return std::move(scene);
  }

 private:
  Purpose purpose_;
  std::string name_;
  tinygltf::Model& model_;
  const TakenOut& taken_out_;
  const scenes::ReadOptions& options_;
  std::vector<std::vector<double>> scales_;
  std::vector<std::string> warnings_;
  ClipChoice clips_;
  std::optional<scenes::Motion> motion_;
  std::optional<glm::dvec3> origin_;
};

/// Reads the scene for a purpose, at `options.time` and then at `further` times (import_gltf_scenes).
void read_scenes(Purpose purpose, const mesh::InputFile& input, const scenes::ReadOptions& options,
                 std::span<const double> further, const TakeScene& take) {
  tinygltf::Model model;
  const TakenOut taken_out = load_gltf_model(input, options, model);
  try {
    ParsedFile file(purpose, input.name.filename().string(), model, taken_out, options);
    const auto take_at = [&](std::optional<double> time) {
      scenes::Scene scene = file.scene_at(time);
      return take(std::move(scene),
                  options.instances == nullptr ? scenes::Instances() : std::exchange(*options.instances, {}));
    };
    bool more = take_at(options.time) && options.time && file.moves();
    for (std::size_t i = 0; more && i < further.size(); ++i) more = take_at(further[i]);
  } catch (const InputError& error) {
    throw InputError("{}: {}", input.name.string(), error.what());  // places alone do not identify the file
  }
}

}  // namespace

void import_gltf_scenes(const mesh::InputFile& input, const scenes::ReadOptions& options,
                        std::span<const double> further, const TakeScene& take) {
  read_scenes(options.needs_light ? Purpose::lit_scene : Purpose::any_scene, input, options, further, take);
}

mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, const scenes::ReadOptions& options) {
  scenes::Scene scene;
  read_scenes(Purpose::mesh, input, options, {}, [&](scenes::Scene read, const scenes::Instances& /*none*/) {
    scene = std::move(read);
    return false;
  });
  mesh::ImportedMesh mesh{std::move(scene.soup), std::move(scene.warnings), {}};
  // Makes one object, whose faces are numbered consecutively.
  std::uint32_t number = 0;
  for (std::uint32_t& face : mesh.soup.source_face) face = number++;
  std::ranges::fill(mesh.soup.object, 0u);
  return mesh;
}

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace penumbra::import
